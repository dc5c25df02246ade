// The list that `auto` takes.
#include "harness/choose_sources.h"
#include "test.h"

namespace ssrlab::test {
namespace {

TEST(ChooseSources, TakesTheListWithMostRightAnswersWithinTheBudget)
{
    const std::vector<MeasuredList> lists = {
        {"frame", 10, 0.7}, {"frame,planar", 14, 0.9}, {"frame,cube", 16, 0.9005}, {"frame,world", 30, 0.99}};
    const std::pair<double, const char*> rows[] = {
        {5, "frame"},         // none fits: the cheapest
        {10, "frame"},        // the budget itself is within it
        {13.9, "frame"},      //
        {14, "frame,planar"}, //
        {20, "frame,planar"}, // the cheaper of two that are equal within 0.1 points
        {30, "frame,world"},
    };
    for (const auto& [budget_ms, text] : rows) EXPECT_EQ(lists[best_within(lists, budget_ms)].text, text) << budget_ms;
    EXPECT_THROW(best_within({}, 1), std::logic_error);
}

} // namespace
} // namespace ssrlab::test

// Runs the GPU tests; a test during which the validation layer said anything has failed.
#include "core/files.h"
#include "gpu/device.h"
#include "repeat_command.h"

namespace {

class FailOnValidationMessages : public testing::EmptyTestEventListener {
    void OnTestEnd(const testing::TestInfo&) override
    {
        const auto messages = ssrlab::validation_messages(ssrlab::test::device());
        for (size_t i = seen_; i < messages.size(); ++i) ADD_FAILURE() << "validation layer: " << messages[i];
        seen_ = messages.size();
    }
    size_t seen_ = 0;
};

} // namespace

int main(int argc, char** argv)
{
    testing::InitGoogleTest(&argc, argv);
    // Surface models are found once per program.
    ::setenv("SSRLAB_TECHNIQUES", (ssrlab::data_root() / "tests/techniques/sloped_slab").c_str(), 1);
    // Before the printer, so that the test it prints as failed is the right one.
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    auto* printer   = listeners.Release(listeners.default_result_printer());
    listeners.Append(printer);
    ssrlab::test::print_repeat_commands(argv[0]);
    listeners.Append(new FailOnValidationMessages);
    return RUN_ALL_TESTS();
}

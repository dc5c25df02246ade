#include "repeat_command.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

namespace ssrlab::test {
namespace {

class Printer : public testing::EmptyTestEventListener {
public:
    explicit Printer(std::string program) : program_(std::move(program)) {}

private:
    void OnTestEnd(const testing::TestInfo& test) override
    {
        if (!test.result()->Failed()) return;
        const char*       driver = std::getenv("VK_ICD_FILENAMES");
        const std::string before = driver == nullptr ? "" : std::string("VK_ICD_FILENAMES=") + driver + " ";
        std::printf("repeat: %s%s --gtest_filter=%s.%s\n", before.c_str(), program_.c_str(), test.test_suite_name(),
                    test.name());
    }

    std::string program_;
};

} // namespace

void print_repeat_commands(const std::string& program)
{
    testing::UnitTest::GetInstance()->listeners().Append(new Printer(program));
}

} // namespace ssrlab::test

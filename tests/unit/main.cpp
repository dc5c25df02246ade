#include "repeat_command.h"
#include "test.h"

int main(int argc, char** argv)
{
    testing::InitGoogleTest(&argc, argv);
    ssrlab::test::print_repeat_commands(argv[0]);
    return RUN_ALL_TESTS();
}

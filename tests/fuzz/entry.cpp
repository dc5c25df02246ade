// libFuzzer's entry of the target that CMakeLists.txt names.
#include "core/error.h"
#include "targets.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, size_t size)
{
    try {
        ssrlab::fuzz::SSRLAB_FUZZ_TARGET({data, size});
    } catch (const ssrlab::SpecError&) {
    } catch (const ssrlab::Failure&) {
    }
    return 0;
}

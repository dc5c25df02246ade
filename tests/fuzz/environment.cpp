#include "targets.h"

#include "scene/environment.h"

namespace ssrlab::fuzz {
namespace {

void load(const std::filesystem::path& file)
{
    std::vector<std::string> warnings;
    load_environment(file, 1, warnings);
}

} // namespace

void feed_environment_exr(Bytes bytes) { load(file_with("sky.exr", bytes)); }
void feed_environment_hdr(Bytes bytes) { load(file_with("sky.hdr", bytes)); }

} // namespace ssrlab::fuzz

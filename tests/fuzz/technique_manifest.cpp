#include "targets.h"

#include "trace/catalogue.h"

namespace ssrlab::fuzz {

void feed_technique_manifest(Bytes bytes)
{
    static const std::vector<Structure> structures = load_catalogue().structures;
    static const auto                   shader     = file_with("technique/trace.glsl", Bytes());
    load_technique(file_with("technique/technique.toml", bytes).parent_path(), structures);
}

} // namespace ssrlab::fuzz

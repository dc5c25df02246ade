#include "targets.h"

#include "trace/structure.h"

namespace ssrlab::fuzz {

void feed_structure_manifest(Bytes bytes)
{
    load_structure(file_with("structure/structure.toml", bytes).parent_path());
}

} // namespace ssrlab::fuzz

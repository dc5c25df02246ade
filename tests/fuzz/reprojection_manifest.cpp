#include "targets.h"

#include "trace/reprojection_strategy.h"

namespace ssrlab::fuzz {

void feed_reprojection_manifest(Bytes bytes)
{
    load_reprojection(file_with("reprojection/reprojection.toml", bytes).parent_path());
}

} // namespace ssrlab::fuzz

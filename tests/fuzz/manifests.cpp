// Targets of folders that the catalogue finds.
#include "targets.h"

#include "trace/catalogue.h"
#include "trace/reprojection_strategy.h"
#include "trace/structure.h"
#include "trace/surface.h"

namespace ssrlab::fuzz {

void feed_technique_manifest(Bytes bytes)
{
    static const std::vector<Structure> structures = load_catalogue().structures;
    static const auto                   shader     = file_with("technique/trace.glsl", Bytes());
    load_technique(file_with("technique/technique.toml", bytes).parent_path(), structures);
}

void feed_structure_manifest(Bytes bytes)
{
    load_structure(file_with("structure/structure.toml", bytes).parent_path());
}

void feed_surface_manifest(Bytes bytes)
{
    static const auto meeting = file_with("surface/meeting.glsl", Bytes()),
                      held    = file_with("surface/held.glsl", Bytes());
    load_surface(file_with("surface/surface.toml", bytes).parent_path());
}

void feed_reprojection_manifest(Bytes bytes)
{
    load_reprojection(file_with("reprojection/reprojection.toml", bytes).parent_path());
}

} // namespace ssrlab::fuzz

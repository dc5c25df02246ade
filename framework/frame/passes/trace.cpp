// The technique.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

RecordFunction prepare(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { dispatch_indirect(commands, frame.trace.technique.trace, frame.rays->launch); };
}

} // namespace

Pass trace_pass()
{
    return {.id      = "trace",
            .summary = "Runs the technique on the list of rays",
            .decide  = needed_if_anything_reflects,
            .prepare = prepare};
}

} // namespace ssrlab

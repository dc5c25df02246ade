#include "targets.h"

#include "harness/experiment.h"

namespace ssrlab::fuzz {

void feed_experiment(Bytes bytes)
{
    constexpr double       most_runs  = 50; // the program expands more, in more time
    static const Catalogue catalogue  = load_catalogue();
    const Experiment       experiment = load_experiment(file_with("experiment.toml", bytes), catalogue);
    if (count_runs(experiment) <= most_runs) expand(experiment, catalogue.techniques);
}

} // namespace ssrlab::fuzz

"""How many times as fast one run is as another, judged by pairs: frames of the two runs in the same round of samples.csv.

Drift of the machine meets both frames of a pair alike and cancels in their ratio. The interval is that of the median of the
ratios by order statistics (the sign test): it assumes that pairs are independent, and no distribution. It covers the median
in at least 95 % of cases for every number of pairs from six up; a bootstrap of the median covered 91 to 95 % in simulation.
"""
import os
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.stats import binom


class Ratio(NamedTuple):
    """low and high are NaN where the interval is not known: below six pairs."""

    median: float
    low: float
    high: float
    pairs: int


def paired_ratio(slow_ms, fast_ms, confidence=0.95):
    """Median of slow / fast over the rounds that both have, with its interval. Series of milliseconds by round."""
    ratios = np.sort((slow_ms / fast_ms).dropna().to_numpy())
    count = len(ratios)
    if count == 0:
        return Ratio(np.nan, np.nan, np.nan, 0)
    # The largest rank whose two tails together keep within 1 - confidence; 0 below six pairs at 95 %.
    rank = int(binom.ppf((1 - confidence) / 2, count, 0.5))
    low, high = (ratios[rank - 1], ratios[count - rank]) if rank > 0 else (np.nan, np.nan)
    return Ratio(float(np.median(ratios)), float(low), float(high), count)


def cost_passes(folder):
    """What a technique costs: its trace and the structures that only it needs, which have a column ID.ms_median each."""
    columns = pd.read_csv(os.path.join(folder, "results.csv"), nrows=0).columns
    return ["trace"] + [name.removesuffix(".ms_median") for name in columns if name.endswith(".ms_median")]


def cost_samples(folder):
    """{run id: milliseconds of trace and structures, by round}; empty for results without samples."""
    path = os.path.join(folder, "samples.csv")
    if not os.path.exists(path):
        return {}
    samples = pd.read_csv(path, dtype={"run_id": str, "pass": str})
    cost = samples[samples["pass"].isin(cost_passes(folder))].groupby(["run_id", "round"], sort=False).ms.sum()
    return {run: part.droplevel("run_id") for run, part in cost.groupby("run_id", sort=False)}

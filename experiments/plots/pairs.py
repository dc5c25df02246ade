"""How many times as fast one run is as another, judged by pairs: frames of the two runs in the same round of samples.csv.

Drift of the machine meets both frames of a pair alike and cancels in their ratio. The interval is that of the median of the
ratios by order statistics (the sign test): it assumes no distribution, but independent pairs. It covers the median then in at
least 95 % of cases for every number of pairs from six up; a bootstrap of the median covered 91 to 95 % in simulation. Rounds
that follow each other share what disturbs the machine. So from 32 pairs on the interval is that of 16 to 31 medians of
neighbouring pairs: where neighbours correlate by 0.3, single pairs covered the median in 90 % of cases, these in 97 %.
"""
import os
from typing import NamedTuple

import numpy as np
import pandas as pd
from scipy.stats import binom

from .results import read_samples


class Ratio(NamedTuple):
    """low and high are NaN where the interval is not known: below six pairs."""

    median: float
    low: float
    high: float
    pairs: int


FEWEST_BLOCKS = 16


def blocks_of(ratios):
    """Medians of neighbours; below twice FEWEST_BLOCKS the ratios themselves."""
    blocks = len(ratios) // max(1, len(ratios) // FEWEST_BLOCKS)
    return np.array([np.median(block) for block in np.array_split(ratios, blocks)])


def paired_ratio(slow_ms, fast_ms, confidence=0.95):
    """Median of slow / fast over the rounds that both have, with its interval. Series of milliseconds by round."""
    ratios = (slow_ms / fast_ms).dropna().sort_index().to_numpy()
    if len(ratios) == 0:
        return Ratio(np.nan, np.nan, np.nan, 0)
    # The largest rank whose two tails together keep within 1 - confidence; 0 below six pairs at 95 %.
    ranked = np.sort(blocks_of(ratios))
    rank = int(binom.ppf((1 - confidence) / 2, len(ranked), 0.5))
    low, high = (ranked[rank - 1], ranked[len(ranked) - rank]) if rank > 0 else (np.nan, np.nan)
    return Ratio(float(np.median(ratios)), float(low), float(high), len(ratios))


def cost_passes(folder):
    """What a technique costs: its trace and the structures that only it needs, which have a column ID.ms_median each."""
    columns = pd.read_csv(os.path.join(folder, "results.csv"), nrows=0).columns
    return ["trace"] + [name.removesuffix(".ms_median") for name in columns if name.endswith(".ms_median")]


def cost_samples(folder):
    """{run id: milliseconds of trace and structures, by round}; empty for results without samples."""
    path = os.path.join(folder, "samples.csv")
    if not os.path.exists(path):
        return {}
    samples = read_samples(folder)
    cost = samples[samples["pass"].isin(cost_passes(folder))].groupby(["run_id", "round"], sort=False).ms.sum()
    return {run: part.droplevel("run_id") for run, part in cost.groupby("run_id", sort=False)}

"""The loops of engines beside settings of ours, from the rows of experiments/engines.toml: what results/reference/engines.md says."""
import sys
from dataclasses import dataclass

import numpy as np
import pandas as pd


@dataclass
class Engine:
    name: str
    technique: str
    default: dict            # by column of the rows; what its settings are called by
    relative: bool = False   # the thickness is a share of the distance

    def rows(self, table):
        return table[(table.technique == self.technique) & (table.thickness_relative == self.relative)]


ENGINES = [
    Engine("Unity HDRP", "unity_hiz", {"thickness_m": 0.01, "max_steps": 64}, relative=True),
    Engine("AMD FidelityFX", "published_hiz", {"thickness_m": 0.015, "max_steps": 128}),
    Engine("Unreal, Lumen's screen traces", "published_hiz", {"thickness_m": 0.005, "max_steps": 50}, relative=True),
    Engine("Unreal, SSR", "unreal_steps", {"steps": 16}),
    Engine("Godot 4.6", "godot_hiz", {"thickness_m": 0.5, "max_steps": 64}),
    Engine("Bevy", "bevy_march", {"thickness_m": 0.25, "steps": 10}),
    Engine("three.js", "three_march", {"thickness_m": 0.1, "quality": 0.5}),
    Engine("Babylon.js", "babylon_dda", {"thickness_m": 0.5, "stride_px": 1, "ends_at_sky": True}),
    Engine("Filament", "filament_dda", {"thickness_m": 0.1, "stride_px": 2, "beyond": True}),
    Engine("Blender EEVEE", "eevee_march", {"thickness_m": 0.2, "quality": 0.25}),
]
OURS = ["technique", "surface", "steps"]
NAMED = {"technique": "hiz_packets", "surface": "plane"}  # the setting of ours that times are relative to
FRAME = ["scene", "width", "height"]


def is_ours(table):
    return ~table.technique.isin([engine.technique for engine in ENGINES])


def with_cost(table):
    """cost_ms is the trace, what only it needs, and for solids the pass that draws their backs; time is relative to the named setting."""
    solids = table.solid_backs_ms.fillna(0) if "solid_backs_ms" in table else 0
    table = table.assign(cost_ms=table.cost_ms + solids)
    named = table[np.logical_and.reduce([table[name] == value for name, value in NAMED.items()])].set_index(FRAME).cost_ms
    return table.assign(time=table.cost_ms / named.reindex(pd.MultiIndex.from_frame(table[FRAME])).to_numpy())


def said(name, value, relative):
    if isinstance(value, (bool, np.bool_)):
        return name if value else f"not {name}"
    if name == "thickness_m":
        return f"{100 * value:g} %" if relative else f"{value:g} m"
    return f"{name} {value:g}"


def of_setting(table, values):
    """Its rows, one a scene. Ends the program where there are none: the default was not measured."""
    rows = table[np.logical_and.reduce([table[name] == value for name, value in values.items()])]
    return rows if len(rows) else sys.exit(f"engines: expected rows of {values}, got none; experiments/engines.toml lacks them")


def best_of(table, names):
    """The setting with the best mean F1 over the scenes."""
    found = table.groupby(names).f1_1px.mean().reset_index()
    return found.loc[found.f1_1px.idxmax(), names].to_dict()


def cells(rows):
    """Of one setting in one size: means over the scenes, of times the geometric one."""
    shares = [f"{rows[name].mean():.0%}" for name in ("recall_1px", "precision_1px", "f1_1px", "recall_4px")]
    return [*shares, f"{rows.fetches_mean.mean():.0f}", f"{np.exp(np.log(rows.time).mean()):.2g}"]


def our_settings(table):
    """(label, rows) of each setting of ours."""
    for (technique, surface, steps), part in table[is_ours(table)].groupby(OURS, sort=False, dropna=False):
        yield f"`{technique}`, `{surface}`" + (f", steps {steps:g}" if steps == steps else ""), part


HEAD = ["loop", "", "setting", "recall", "precision", "F1", "recall, 4 px", "fetches", "time"]


def comparison(table):
    """A line for each engine by default and at its best, and for each setting of ours. The table is of one size."""
    for engine in ENGINES:
        own  = engine.rows(table)
        best = best_of(own, list(engine.default))
        for kind, values in {"default": engine.default, "best F1": best}.items():
            if kind == "default" or best != engine.default:
                label = ", ".join(said(name, value, engine.relative) for name, value in values.items())
                yield [engine.name, kind, label, *cells(of_setting(own, values))]
    for label, own in our_settings(table):
        yield ["ours", "", label, *cells(own)]


def is_beaten(rival, ours, price):
    """Is there a row of ours, of the same frame, that finds more of what is visible, has fewer wrong hits and a lower price?"""
    return ((ours.recall_1px > rival.recall_1px) & (ours.precision_1px > rival.precision_1px) & (ours[price] < rival[price])).any()


def dominance(table):
    """A line for each engine: its runs, and the shares of them that one setting of ours beats by time and by fetches."""
    frames = dict(list(table[is_ours(table)].groupby(FRAME)))
    wins = pd.DataFrame([{"loop": engine.name, **{price: is_beaten(row, frames[tuple(row[FRAME])], price) for price in ("cost_ms", "fetches_mean")}}
                         for engine in ENGINES for _, row in engine.rows(table).iterrows()])
    for name, part in [*wins.groupby("loop", sort=False), ("all", wins)]:
        yield [name, str(len(part)), f"{part.cost_ms.mean():.0%}", f"{part.fetches_mean.mean():.0%}"]

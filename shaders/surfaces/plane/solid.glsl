// Nothing: only what needs = ["solid"] knows where solids end.

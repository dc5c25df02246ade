// Nothing: only what needs = ["gradient"] has planes.

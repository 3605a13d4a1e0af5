/* A comparison as JSON, for `cuvette study compare --json` and for the laboratory. Ownership: a new reference, NULL if
 * memory runs out. */
#pragma once

#include "study/contrast.h"
#include <jansson.h>

/* {"columns": paths of the grid, "count", "environments": [A, B], "cells": [line with the values of A's cell, ..],
 * "all": line}; at most `most` cells. A line: {"a": {"cell", "n", "processes", "median"}, "b", "ratio", "low", "high",
 * "verdict", "reason", "alternate", "pairs_needed", "same_film": BOOL or null}; null for unknown numbers. */
json_t *contrast_json(const study *s, const contrast *c, size_t most);

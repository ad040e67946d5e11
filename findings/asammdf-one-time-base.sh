#!/usr/bin/env bash
# asammdf 8.8.28: channels of two rates as one table.
#
# A reader expects that a table of a 50 Hz and a 10 Hz channel, which both cover 0 to 1 s, has 51 rows, and no value where nothing was
# measured. By default (`to_dataframe`, and `export` with `single_time_base=True`):
#
# * each row has a value of each channel: of a float channel on the line between its samples, of an integer channel the last sample again.
#   Nothing in the table marks them. 40 of 51 values of the slow channels were never measured, and their noise looks small.
# * the rows are the union of the time stamps as binary numbers. 0.3 and 0.30000000000000004, of the two clocks, are two rows: 53 rows.
#
# What helps: `use_interpolation=False` leaves the other rows empty; `raster` makes rows at a fixed step.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet asammdf==8.8.28 numpy==2.4.6 pandas==3.1.1
"$folder/venv/bin/python" - <<'PYTHON'
from importlib.metadata import version

import numpy as np
from asammdf import MDF, Signal

fast, slow = np.arange(51) * 0.02, np.arange(11) * 0.1
log = MDF()
log.append([Signal(np.sin(6 * fast), fast, name="current", unit="A")])
log.append([Signal(slow**2, slow, name="pressure", unit="bar")])
log.append([Signal((np.arange(11) ** 2).astype("u1"), slow, name="counter")])
table = log.to_dataframe()
print("asammdf", version("asammdf"))
print(len(table), "rows;", int(table.isna().to_numpy().sum()), "empty cells")
print(table.iloc[5:11])

assert len(table) == 53
steps = np.diff(table.index.to_numpy())
assert (steps < 1e-12).sum() == 2, steps.min()
assert not table.isna().to_numpy().any()
between = table.loc[0.12]
assert np.isclose(between["pressure"], 0.016) and between["counter"] == 1
plain = log.to_dataframe(use_interpolation=False)
assert plain["pressure"].notna().sum() == 11
print("as described")
PYTHON

"""Numbers with more digits than a double has."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import Error


def decimals(table: Any, name: str) -> npt.NDArray[Any]:
    """Returns the column t, q, p or energy as decimal.Decimal (dtype object), shaped like the column of doubles.

    Raises
    ------
    Error
        If the table has no more digits than doubles.
    """
    if f"digits/{name}" not in table:
        raise Error("digits: found True, but the samples are doubles; allowed in arithmetic with more digits than double")
    texts = np.array(table[f"digits/{name}"], dtype=object).reshape(table[name].shape)
    found = np.empty(texts.shape, dtype=object)
    for place in np.ndindex(texts.shape):
        found[place] = Decimal(texts[place])
    return found

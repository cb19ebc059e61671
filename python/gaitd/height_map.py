"""The ground, as a grid of heights."""

from __future__ import annotations

import base64
from dataclasses import dataclass, field
from typing import Any, Dict, Iterator, Mapping, Optional, Tuple

import numpy as np

from .arrays import Array

__all__ = ["HeightMap"]

_TILE = 96  # cells, in both directions, of one request
_UNKNOWN = -32768


@dataclass
class HeightMap:
    """A grid of heights over the plane.

    heights: m in the world, shape (rows, columns): a row has one y, and x grows along it; NaN where nothing is known.
    origin: (x, y) in m of the corner of least x and y. resolution: m per cell. variance: m^2 of every height, or an
    array of the shape of heights.
    """

    heights: Array
    origin: Tuple[float, float] = (0.0, 0.0)
    resolution: float = 0.02
    variance: Any = field(default=0.0)

    def height(self, x: float, y: float) -> float:
        """m, of the cell at (x, y); NaN where nothing is known."""
        column = int(np.floor((x - self.origin[0]) / self.resolution))
        row = int(np.floor((y - self.origin[1]) / self.resolution))
        rows, columns = self.heights.shape
        if not (0 <= row < rows and 0 <= column < columns):
            return float("nan")
        return float(self.heights[row, column])

    @staticmethod
    def _from_answer(answer: Mapping[str, Any]) -> Optional["HeightMap"]:
        if "heights" not in answer:
            return None
        raw = np.frombuffer(base64.b64decode(answer["heights"]), dtype="<i2")
        heights = np.where(raw == _UNKNOWN, np.nan, answer["scale"] * raw.astype(float))
        x, y = answer["origin"]
        return HeightMap(
            heights.reshape(answer["rows"], answer["columns"]), (float(x), float(y)), float(answer["resolution"])
        )

    def _tiles(self) -> Iterator[Dict[str, Any]]:
        heights = np.asarray(self.heights, dtype="<f4")
        if heights.ndim != 2:
            raise ValueError(f"heights: shape (rows, columns) expected, got {heights.shape}")
        variances = np.broadcast_to(np.asarray(self.variance, dtype="<f4"), heights.shape)
        for row in range(0, heights.shape[0], _TILE):
            for column in range(0, heights.shape[1], _TILE):
                part = np.s_[row : row + _TILE, column : column + _TILE]
                yield {
                    "rows": heights[part].shape[0],
                    "columns": heights[part].shape[1],
                    "resolution": self.resolution,
                    "origin": [self.origin[0] + column * self.resolution, self.origin[1] + row * self.resolution],
                    "heights": base64.b64encode(np.ascontiguousarray(heights[part]).tobytes()).decode(),
                    "variances": base64.b64encode(np.ascontiguousarray(variances[part]).tobytes()).decode(),
                }

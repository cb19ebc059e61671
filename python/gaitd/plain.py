"""What JSON knows, of what Python and numpy have."""

from __future__ import annotations

import os
from typing import Any, Mapping

__all__ = ["plain"]


def plain(value: Any) -> Any:
    """With numpy's scalars and arrays, paths and tuples as what JSON knows."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    return value

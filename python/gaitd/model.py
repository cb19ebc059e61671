"""The robot model: links, joints, and where they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Mapping, Tuple

import numpy as np

from . import _native
from .arrays import Floats
from .errors import LogError
from .signal_table import missing

__all__ = ["Joint", "Model"]


@dataclass(frozen=True)
class Joint:
    """A joint that moves: limits of position (rad; m if it slides), velocity (rad/s or m/s), effort (N m or N)."""

    name: str
    position_min: float
    position_max: float
    velocity_limit: float
    effort_limit: float


class Model:
    """The robot as gaitd takes it: of a log (``log.model``) or of a daemon (``robot.model()``).

    metadata: ``robot_urdf`` and what a log says of the robot besides. Raises :class:`LogError` where there is no
    description that can be read.
    """

    def __init__(self, metadata: Mapping[str, str]):
        try:
            self._native = _native.Model(dict(metadata))
        except RuntimeError as error:
            raise LogError(str(error)) from None
        self._joints = [Joint(*row) for row in self._native.joints()]
        self._links = list(self._native.links())
        self._urdf = metadata["robot_urdf"]

    @property
    def name(self) -> str:
        """Of the robot in the URDF."""
        return str(self._native.name)

    @property
    def total_mass(self) -> float:
        """kg."""
        return float(self._native.total_mass)

    @property
    def urdf(self) -> str:
        """Text of the URDF."""
        return self._urdf

    @property
    def joints(self) -> List[Joint]:
        """Those that move, in the order in which ``poses`` takes them."""
        return list(self._joints)

    @property
    def links(self) -> List[str]:
        """Every link of the URDF, those on fixed joints too."""
        return list(self._links)

    def __repr__(self) -> str:
        return f"<gaitd.Model {self.name!r}: {len(self._links)} links, {len(self._joints)} joints>"

    def poses(self, link: str, pelvis: Floats, joints: Floats) -> Floats:
        """Homogeneous matrices of shape (n, 4, 4): the link in the world, m.

        pelvis: (n, 6), x, y, z (m), roll, pitch, yaw (rad) as in the signals ``pelvis/*``. joints: (n, joints), rad
        or m. One row, of shape (6,) and (joints,), is taken too and gives (4, 4). Raises :class:`MissingSignal` for a
        link that is not there, ValueError for other shapes.
        """
        if link not in self._links:
            raise missing(link, self._links, "link")
        pelvis = np.asarray(pelvis, dtype=float)
        joints = np.asarray(joints, dtype=float)
        poses = self._native.poses(self._links.index(link), np.atleast_2d(pelvis), np.atleast_2d(joints))
        return poses.reshape(4, 4) if pelvis.ndim == 1 else poses

    def positions(
        self,
        link: str,
        pelvis: Floats,
        joints: Floats,
        point: Tuple[float, float, float] = (0.0, 0.0, 0.0),
    ) -> Floats:
        """Where a point of a link is in the world: (n, 3), m. point: in the frame of the link, m; else as ``poses``."""
        return placed(self.poses(link, pelvis, joints), point)


def placed(poses: Floats, point: Tuple[float, float, float]) -> Floats:
    """Where a point of a link is, for each of its poses: (..., 3), m. point: in the frame of the link, m."""
    offset = np.asarray(point, dtype=float)
    if offset.shape != (3,):
        raise ValueError(f"point={point!r}: expected three numbers, x, y, z in m")
    result: Floats = poses[..., :3, 3] + poses[..., :3, :3] @ offset
    return result

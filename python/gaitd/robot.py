"""A robot that a gaitd controls: commands, waiting, events."""

from __future__ import annotations

import time
import weakref
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from .drive import Drive
from .errors import Fault, WaitTimeout
from .height_map import HeightMap
from .log import Event
from .model import Model
from .rpc import Connection

__all__ = ["Robot", "connect"]

_LOOK_PERIOD = 0.01  # s


def _given(**params: Any) -> Dict[str, Any]:
    """Those that are not None."""
    return {name: value for name, value in params.items() if value is not None}


def connect(socket: str = "", *, role: str = "command") -> "Robot":
    """The robot of a running gaitd.

    socket: the path of its socket of commands; by default where ``gaitctl`` looks for it. role: ``"command"``, or
    ``"observe"`` for a socket that may only look. Raises :class:`NoDaemon`.
    """
    return Robot(socket, role=role)


class Robot:
    """A connection to gaitd. Commands return when gaitd has taken them; ``wait`` waits for the robot.

    >>> with gaitd.connect() as robot:
    ...     robot.walk(6, length=0.3)
    ...     robot.wait("standing", timeout=30)

    Every command gives what gaitd answers, a dict with ``tick`` (of the tick that took it) and ``note`` (what is worth
    knowing about the effect, or None), and raises :class:`Refused` where gaitd refuses it, :class:`NoDaemon` where
    gaitd is gone. Use a Robot in one thread only; each thread may have its own.
    """

    def __init__(self, socket: str = "", *, role: str = "command"):
        self._connection = Connection(socket, role)
        self._given = socket
        self._role = role
        self._taken = -1  # tick of the last command
        self._drives: "weakref.WeakSet[Drive]" = weakref.WeakSet()

    def __enter__(self) -> "Robot":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<gaitd.Robot on {self.socket}>"

    def close(self) -> None:
        """Ends the connection, and what drives the robot. It goes on with what else it was told."""
        try:
            for drive in list(self._drives):
                try:
                    drive.end()
                except Exception:  # what it failed of: it does not drive any more
                    pass
        finally:
            self._connection.close()

    @property
    def socket(self) -> str:
        """Path of the socket that is connected."""
        return self._connection.path

    def call(self, method: str, timeout: float = 10.0, **params: Any) -> Any:
        """Any method of docs/protocol.md with its params: ``robot.call("plugin.swap", layer="toe_off", to="never")``.

        timeout: s for the answer.
        """
        result = self._connection.call(method, params or None, timeout)
        if isinstance(result, dict) and result.get("accepted") and isinstance(result.get("tick"), int):
            self._taken = max(self._taken, result["tick"])
        return result

    # ---- What it does.

    def status(self) -> Dict[str, Any]:
        """What the robot does at the newest tick, as in docs/protocol.md."""
        return dict(self.call("status"))

    def model(self) -> Model:
        """Its links and joints."""
        described = self.call("robot.describe")
        return Model({"robot_urdf": described["urdf"], **(described["log"] or {})})

    def wait(self, state: Union[str, Sequence[str]] = "standing", timeout: float = 60.0) -> Dict[str, Any]:
        """Waits until the robot is in the state, or one of them, after what was commanded last; gives its status.

        ``"standing"`` is reached when no footsteps are ahead and no ``goto`` plans any, or they are paused. States are
        those of ``status``: disarmed, readying, standing, walking, stopping, testing, fault. timeout: s of this
        machine's clock.

        Raises :class:`Fault` when a fault comes instead, :class:`WaitTimeout` when the time is over.
        """
        wanted = (state,) if isinstance(state, str) else tuple(state)
        known = ("disarmed", "readying", "standing", "walking", "stopping", "testing", "fault")
        if unknown := [one for one in wanted if one not in known]:
            raise ValueError(f"state {unknown[0]!r}: expected one of {', '.join(known)}")
        deadline = time.monotonic() + timeout
        while True:
            status = self.status()
            # The tick that took the command shows its effect only at the end.
            if status["tick"] is not None and status["tick"] > self._taken:
                ahead = status["footsteps_ahead"] or status["goto"] is not None
                ready = status["state"] != "standing" or not ahead or status["paused"]
                if status["state"] in wanted and ready:
                    return status
                if status["state"] == "fault":
                    raise Fault(status["faults"], " or ".join(wanted))
            if time.monotonic() > deadline:
                raise WaitTimeout(f"the robot is {status['state']} after {timeout:g} s, not {' or '.join(wanted)}")
            time.sleep(_LOOK_PERIOD)

    def events(self, timeout: Optional[float] = None) -> Iterator[Event]:
        """Commands, states, faults, swaps, parameters, as they happen, over a connection of its own.

        It is connected when this returns: what happens from here on is in it. An event of the kind "lost" says how many
        were left out because they were not read in time. The iterator ends when nothing happened
        for timeout (s); None: it waits. Raises :class:`NoDaemon` when gaitd ends.
        """
        connection = Connection(self.socket, "observe")
        connection.call("telemetry.subscribe", {"signals": ["tick"], "rate": 5, "events": True})
        return _events(connection, timeout)

    # ---- Commands.

    def walk(self, steps: int, length: float = 0.0, **how: Any) -> Dict[str, Any]:
        """Appends footsteps that advance, and one that closes beside the last.

        steps: how many. length: m ahead per step. how: lateral (m, positive to the left), width (m between the soles),
        turn (rad per step, positive to the left), swing and transfer (s), first ("left" or "right").
        """
        return dict(self.call("walk", steps=steps, length=length, **how))

    def drive(
        self, forward: float = 0.0, lateral: float = 0.0, turn: float = 0.0, *, seconds: Optional[float] = None
    ) -> Drive:
        """Walks at a velocity: forward and lateral in m/s (positive to the left), turn in rad/s.

        Without seconds it goes on in the background until the :class:`Drive` ends, also with a ``with`` block, is
        dropped, or this robot is closed; with seconds this returns after that time, s of this machine's clock, and the
        robot comes to a stand. If this program ends or is stopped, the robot comes to a stand by itself (drive.timeout,
        0.5 s); while it waits for something else, it is driven on.
        """
        drive = Drive(self.socket, forward, lateral, turn)
        self._drives.add(drive)
        self._taken = max(self._taken, drive.tick)
        if seconds is not None:
            with drive:
                drive.sleep(seconds)
            self._taken = max(self._taken, drive.tick)
        return drive

    def footsteps(self, footsteps: Sequence[Mapping[str, Any]], *, replace: bool = False) -> Dict[str, Any]:
        """Appends footsteps, dicts with side, x, y (m, world) and more as in docs/protocol.md.

        replace: in place of those that have not begun.
        """
        return dict(self.call("footsteps", footsteps=[dict(step) for step in footsteps], replace=replace))

    def goto(self, x: float, y: float, yaw: Optional[float] = None, *, timeout: float = 60.0) -> Dict[str, Any]:
        """Plans footsteps to a place over the ground that gaitd knows, and walks there.

        x, y: of the middle of the feet, m in the world. yaw: heading there, rad; without it as it comes. timeout: s, for
        the plan. Raises :class:`Refused` where there is no way, with what blocks it.
        """
        place = {"x": x, "y": y} if yaw is None else {"x": x, "y": y, "yaw": yaw}
        return dict(self.call("goto", timeout=timeout, **place))

    def map(self, resolution: float = 0.0) -> Optional[HeightMap]:
        """The ground as gaitd knows it, or None if nothing is known and it takes the ground for level.

        resolution: m per cell at least; cells are coarser where there would be more than 200,000.
        """
        return HeightMap._from_answer(self.call("map.get", resolution=resolution) if resolution else self.call("map.get"))

    def map_put(self, map: HeightMap, *, forget: bool = False) -> int:
        """Tells gaitd of the ground; what it knew of these cells is replaced. How many cells it took.

        forget: where the map has NaN, gaitd is to know nothing either.
        """
        return sum(self.call("map.put", forget=forget, **tile)["cells"] for tile in map._tiles())

    def map_clear(self) -> None:
        """Forgets what was told or seen of the ground, but for goto.height_map."""
        self.call("map.clear")

    def mode(self, mode: str) -> Dict[str, Any]:
        """``"walk-straight"``, ``"walk-bent"`` or ``"stand"``; while walking from the next step on."""
        return dict(self.call("mode", mode=mode))

    def pose(
        self,
        part: str = "pelvis",
        side: Optional[str] = None,
        *,
        duration: float = 1.5,
        points: Optional[Sequence[Mapping[str, Any]]] = None,
        **where: Any,
    ) -> Dict[str, Any]:
        """Moves ``"pelvis"``, ``"chest"``, or ``"arm"`` or ``"hand"`` of a side (``"left"``, ``"right"``).

        where: x, y, z (m), roll, pitch, yaw (rad); of a hand also frame (``"world"``, ``"chest"``, ``"pelvis"``), of an
        arm ``joints={name: rad}``; nothing: back. duration: s of the way there. points: a way in place of one point,
        dicts with time (s) and the same keys. The answer has a ``note`` where a hand cannot get there.
        """
        if side is not None:
            where["side"] = side
        if points is not None:
            where["points"] = [dict(point) for point in points]
        params: Dict[str, Any] = {part: where}
        if points is None:
            params["duration"] = duration
        return dict(self.call("pose", **params))

    def arm(self) -> Dict[str, Any]:
        """Enables the drives and stands up; ``wait("standing")`` waits for it."""
        return dict(self.call("arm"))

    def disarm(self) -> Dict[str, Any]:
        """Takes the joints out of control; they are damped."""
        return dict(self.call("disarm"))

    def estop(self) -> Dict[str, Any]:
        """Latches the fault estop: the joints are damped until ``reset``, then ``arm``."""
        return dict(self.call("estop"))

    def reset(self) -> Dict[str, Any]:
        """Clears a latched fault; the robot is disarmed then."""
        return dict(self.call("reset"))

    def stop(self) -> Dict[str, Any]:
        """Finishes the present step, closes the feet and stands."""
        return dict(self.call("stop"))

    def abort(self) -> Dict[str, Any]:
        """Drops the footsteps ahead, puts the foot down where it is going and stands."""
        return dict(self.call("abort"))

    def pause(self) -> Dict[str, Any]:
        """Stands after the present step and keeps the footsteps ahead until ``resume``."""
        return dict(self.call("pause"))

    def resume(self) -> Dict[str, Any]:
        """Goes on after a pause."""
        return dict(self.call("resume"))

    def payload_estimate(self, link: Optional[str] = None, *, timeout: float = 30.0) -> Dict[str, Any]:
        """Weighs what a link of the standing robot carries, which takes four seconds; the controller counts on it then.

        link: by default the chest. timeout: s. Gives ``payload`` of the status: the mass and the loads, each with its
        centre of mass in the frame of its link and the standard deviation of that. Raises :class:`WaitTimeout` with
        the reason where nothing could be weighed.
        """
        began = self.call("payload.estimate", **_given(link=link))["tick"]
        end = time.monotonic() + timeout
        while time.monotonic() < end:
            status = self.status()
            payload = status["payload"]
            if status["tick"] > began and not payload["estimating"]:
                if payload["outcome"] in ("found", "nothing"):
                    return dict(payload)
                raise WaitTimeout("the payload was not weighed: " + payload["what"])
            time.sleep(_LOOK_PERIOD)
        raise WaitTimeout(f"the payload was not weighed within {timeout:g} s")

    def payload_set(
        self, link: str, mass: float, com: Sequence[float] = (0.0, 0.0, 0.0)
    ) -> Dict[str, Any]:
        """Says what a link carries, in place of what was known. mass: kg. com: m, in the frame of the link."""
        return dict(self.call("payload.set", link=link, mass=mass, com=list(com)))

    def payload_clear(self, link: Optional[str] = None) -> Dict[str, Any]:
        """Says that nothing is carried any more, by ``link`` or by all of them."""
        return dict(self.call("payload.clear", **_given(link=link)))

    def handhold_take(
        self, hand: str, normal: Sequence[float], force: float, friction: Optional[float] = None
    ) -> Dict[str, Any]:
        """Presses a hand, ``"left"`` or ``"right"``, on a surface, and counts on it once something stops it.

        normal: from the surface towards the robot: ahead, to the left, up. force: N along it, at most. friction: of
        the hand on the surface, 0.5 if left out.
        """
        rest = _given(friction=friction)
        return dict(self.call("handhold.take", hand=hand, normal=list(normal), force=force, **rest))

    def handhold_release(self, hand: Optional[str] = None) -> Dict[str, Any]:
        """Lets go with a hand, or with both."""
        return dict(self.call("handhold.release", **_given(hand=hand)))

    def tare(self) -> Dict[str, Any]:
        """Takes what seems to pull at the standing robot for nothing: nobody touches it now, nor in the next two seconds."""
        return dict(self.call("tare"))

    def push(
        self, link: str, force: Tuple[float, float, float], duration: float, point: Optional[Sequence[float]] = None
    ) -> Dict[str, Any]:
        """Pushes a link of a simulated robot.

        force: N, world axes. duration: s. point: m, in the frame of the link; by default its origin.
        """
        where = _given(point=None if point is None else list(point))
        return dict(self.call("sim.push", link=link, force=list(force), duration=duration, **where))

    def load(self, link: str, mass: float, com: Sequence[float] = (0.0, 0.0, 0.0)) -> Dict[str, Any]:
        """Puts a mass (kg) on a link of a simulated robot, in place of what was there; 0: takes it off.

        com: m, in the frame of the link. The controller is not told: see ``payload_set`` and ``payload_estimate``.
        """
        return dict(self.call("sim.load", link=link, mass=mass, com=list(com)))

    def sim_reset(self) -> Dict[str, Any]:
        """Puts a simulated robot back to the start and arms it."""
        return dict(self.call("sim.reset"))

    # ---- Parameters and layers.

    def params(self, match: str = "*") -> List[Dict[str, Any]]:
        """Parameters whose names the glob matches, with value, unit, range, default and effect."""
        return list(self.call("param.list", match=match)["parameters"])

    def get(self, name: str) -> Union[float, int, bool]:
        """The value of a parameter, in its unit."""
        value: Union[float, int, bool] = self.call("param.get", name=name)["value"]
        return value

    def set(self, name: str, value: Union[float, int, bool]) -> Dict[str, Any]:
        """Changes a parameter, while it walks too, until gaitd ends."""
        return dict(self.call("param.set", name=name, value=value))

    def swap(self, layer: str, to: str) -> Dict[str, Any]:
        """Exchanges a layer while it walks, and returns when that is over.

        to: an installed variant, or the path of a library.
        """
        return dict(self.call("plugin.swap", timeout=30.0, layer=layer, to=to))

    def rollback(self, layer: str) -> Dict[str, Any]:
        """Back to the layer before the last swap."""
        return dict(self.call("plugin.rollback", layer=layer))


def _events(connection: Connection, timeout: Optional[float]) -> Iterator[Event]:
    try:
        quiet_since = time.monotonic()
        for message in connection.notifications(timeout):
            if message["method"] == "telemetry.event":
                params = message["params"]
                if params.get("lost"):
                    yield Event(params["tick"], params["time"], "lost", {"events": params["lost"]})
                yield Event(params["tick"], params["time"], params["kind"], params["text"])
                quiet_since = time.monotonic()
            elif timeout is not None and time.monotonic() - quiet_since > timeout:
                return
    finally:
        connection.close()

"""Postures for a grid of placements: one task whose targets are moved along axes. A job is a row of the grid. Within a row, the search for
a place starts from the posture of its neighbour. So the result of a row depends only on that row."""
import json
import math

import fcl_stpbv
from fcl_stpbv.batch import bundle
from fcl_stpbv.batch.postures import Postures

MOST_CELLS = 1000000
MOST_COLUMNS = 10000  # in a row, which is one job


def refuse(where, got, expected):
    raise fcl_stpbv.Error(f"{where}: got {json.dumps(got)[:60]}, expected {expected}")


def loaded(text, where):
    def once(pairs):
        known = {}
        for key, value in pairs:
            if key in known:
                raise fcl_stpbv.Error(f"{where}: has the key '{key}' twice; remove one")
            known[key] = value
        return known

    try:
        return json.loads(text, object_pairs_hook=once)
    except (ValueError, RecursionError) as error:
        raise fcl_stpbv.Error(f"{where}: is no JSON: {error}") from None


def number(where, value, kind=(int, float), least=-1e6, most=1e6):
    if isinstance(value, bool) or not isinstance(value, kind) or not least <= value <= most:
        refuse(where, value, f"a {'whole ' if kind is int else ''}number from {least:g} to {most:g}")
    return value


def direction(where, value):
    if not isinstance(value, list) or len(value) != 3:
        refuse(where, value, "three numbers")
    return [number(f"{where}[{i}]", part) for i, part in enumerate(value)]


def placement_names(placements):
    """The names as the library gives them: those that several placements share are numbered."""
    names = [placement.get("name", placement["link"]) for placement in placements]
    return [name if names.count(name) == 1 else f"{name}#{names[:i + 1].count(name)}" for i, name in enumerate(names)]


class Axis:
    """One axis of the grid. The targets move by `values` (m) times the directions of the placements that move."""

    def __init__(self, given, where, names):
        if not isinstance(given, dict):
            refuse(where, given, "an object")
        for key in given.keys() - {"name", "move", "base", "from", "to", "count"}:
            refuse(where, key, "only the keys name, move, base, from, to, count")
        for key in ("name", "move", "from", "to", "count"):
            if key not in given:
                raise fcl_stpbv.Error(f"{where}.{key}: is missing")
        if not isinstance(given["name"], str):
            refuse(f"{where}.name", given["name"], "a text")
        if not isinstance(given["move"], dict) or not given["move"]:
            refuse(f"{where}.move", given["move"], "an object of placements and directions")
        for name in given["move"]:
            if name not in names:
                refuse(f"{where}.move", name, f"a placement of the task: {', '.join(sorted(names))}")
        self.name = given["name"]
        self.moves = {name: direction(f"{where}.move.{name}", by) for name, by in given["move"].items()}
        self.base = direction(f"{where}.base", given.get("base", [0, 0, 0]))
        first, last = number(f"{where}.from", given["from"]), number(f"{where}.to", given["to"])
        count = number(f"{where}.count", given["count"], int, 1, MOST_COLUMNS)
        self.values = [first + (last - first) * i / max(1, count - 1) for i in range(count)]


class Placements:
    """A task at every place of a grid. The last axis is along a row."""

    def __init__(self, task, grid, path):
        self.task = loaded(task, "the task")
        self.names = placement_names(self.task["placements"])
        given = loaded(grid, path)
        if not isinstance(given, dict) or list(given) != ["axes"] or not isinstance(given["axes"], list) or not given["axes"]:
            raise fcl_stpbv.Error(f"{path}: expected an object with a list of axes, such as {{\"axes\": [...]}}")
        self.axes = [Axis(axis, f"{path}: axes[{i}]", set(self.names)) for i, axis in enumerate(given["axes"])]
        fixed = [name for name in self.task.get("start", {}).get("joints", {}) if name in ("base/x", "base/y", "base/z")]
        if fixed and any(any(axis.base) for axis in self.axes):
            raise fcl_stpbv.Error(f"{path}: an axis moves the start's base, which the task's start.joints holds at its {fixed[0]}; "
                                  "give start.base instead")
        self.columns = len(self.axes[-1].values)
        self.rows = math.prod(len(axis.values) for axis in self.axes[:-1])
        if self.rows * self.columns > MOST_CELLS:
            raise fcl_stpbv.Error(f"{path}: has {self.rows * self.columns} places, expected at most {MOST_CELLS}")

    def values(self, row, column):
        """The position of a place along each axis (m)."""
        at, left = [column], row
        for axis in reversed(self.axes[:-1]):
            left, i = divmod(left, len(axis.values))
            at.insert(0, i)
        return [axis.values[i] for axis, i in zip(self.axes, at)]

    def text(self, row, column):
        """The task at one place."""
        task = json.loads(json.dumps(self.task))
        start = task.setdefault("start", {}).setdefault("base", {})
        base = start.get("position", [0, 0, 0])
        targets = [placement["target"] for placement in task["placements"]]
        for axis, value in zip(self.axes, self.values(row, column)):
            base = [b + value * by for b, by in zip(base, axis.base)]
            for target, name in zip(targets, self.names):
                if name in axis.moves:
                    target["position"] = [p + value * by for p, by in zip(target.get("position", [0, 0, 0]), axis.moves[name])]
        start["position"] = base
        return json.dumps(task)


class Place:
    """The best posture at one place so far, and the work to find it."""

    def __init__(self):
        self.best, self.iterations, self.distances = None, 0, 0

    def attempt(self, start, posture):
        self.iterations += posture["iterations"]
        self.distances += posture["distance_calls"]
        missed = sum(amount for _, amount in posture["violations"])
        if self.best is None or missed < self.best[0]:
            self.best = missed, {"feasible": posture["feasible"], "start": start, "cost": posture["cost"], "q": posture["q"],
                                 "conflict": posture["conflict"]}

    @property
    def feasible(self):
        return self.best is not None and self.best[1]["feasible"]

    def record(self):
        return {**self.best[1], "iterations": self.iterations, "distance_calls": self.distances}


class Grid(Postures):
    """Solves the places of a row from left to right: from the left neighbour's posture first, then from the task's own starts. Then it goes
    back from right to left, for places without a posture whose right neighbour has one."""
    name, key = "grid", [int]

    def __init__(self, arguments):
        super().__init__(arguments)
        if len(self.tasks) != 1:
            raise fcl_stpbv.Error(f"--grid: moves one task, got {len(self.tasks)}; give one")
        self.options.update(starts=arguments.starts, neighbours=not arguments.independent)
        self.files["task.json"], self.files["grid.json"] = next(iter(self.tasks.values())).encode(), bundle.read(arguments.grid, pipe=True)
        self.options["tasks"] = bundle.digest_of({name: self.files[name] for name in ("task.json", "grid.json")})
        self.places = self.placements(self.files, arguments.grid)
        self.context = self.context, self.places
        self.groups = list(range(self.places.rows))

    @staticmethod
    def placements(files, path):
        return Placements(files["task.json"], files["grid.json"], path)

    @staticmethod
    def open(folder, options):
        files = {name: (folder / name).read_bytes() for name in ("task.json", "grid.json")}
        return Postures.open(folder, options), Grid.placements(files, "grid.json")

    @staticmethod
    def run(context, options, job, given):
        search, places = context
        texts = [places.text(job[0], column) for column in range(places.columns)]
        row = [Place() for _ in texts]

        def attempt(i, origin, **where):
            row[i].attempt(origin, search.solve(texts[i], "the grid's task", seed=options["seed"], **where))

        def from_neighbour(i, other):
            if options["neighbours"] and row[other].feasible:
                attempt(i, "neighbour", start_from=row[other].best[1]["q"])

        for i in range(len(row)):
            if i > 0:
                from_neighbour(i, i - 1)
            for start in range(options["starts"]):
                if not row[i].feasible:
                    attempt(i, start, start=start)
        for i in reversed(range(len(row) - 1)):
            if not row[i].feasible:
                from_neighbour(i, i + 1)
        return {"places": [place.record() for place in row]}, None

    def fits(self, job, record):
        places = record["places"]
        return len(places) == self.places.columns and all(type(place["feasible"]) is bool and "start" in place for place in places)

    def jobs(self, row, done):
        return [] if (row,) in done else [((row,), None)]

    def summary(self, done):
        places = [place for record in done.values() for place in record.get("places", [])]
        found = sum(place["feasible"] for place in places)
        warm = sum(place["feasible"] and place["start"] == "neighbour" for place in places)
        return f"{len(places)} places: {found} with a posture, {warm} of them from a neighbour's; {len(places) - found} without"

"""Postures for a grid of placements: a row depends on itself alone, what is found is true, wrong grids are refused."""
import json
import xml.etree.ElementTree

import numpy as np
import pytest

import fcl_stpbv
from fcl_stpbv.batch.grid import Placements
from test_batch import ARM, DATA, TOOLS, batch

TASK = TOOLS / "reach.json"
UP, ALONG = {"tool": [0, 0, 1]}, {"tool": [1, 0.5, 0]}
AXES = [{"name": "up", "move": UP, "from": -0.2, "to": 0.5, "count": 2}, {"name": "again up", "move": UP, "from": 0, "to": 0.1, "count": 2},
        {"name": "along", "move": ALONG, "from": -0.6, "to": 0.6, "count": 9}]


def ask(folder, name, *more, axes=AXES, status=0):
    """The records of a batch for this grid, or its error message."""
    grid, out = folder / "grid.json", folder / name
    grid.write_text(json.dumps({"axes": axes}))
    said = batch("postures", ARM, TASK, "--grid", grid, "--starts", 2, *more, "-o", out, status=status)
    return said if status else [json.loads(line) for line in out.read_text().splitlines()[1:]]


def target(row, column):
    """The place where the tool must be: AXES computed again, by hand."""
    up = [-0.2, 0.5][row // 2] + [0, 0.1][row % 2]
    along = -0.6 + 0.15 * column
    return np.array([0.35 + along, 0.2 + 0.5 * along, 0.3 + up])


def tool_at(q):
    """The place of the arm's tool, from its URDF only."""
    turn, place, values = np.eye(3), np.zeros(3), iter(q)
    for joint in xml.etree.ElementTree.parse(ARM).getroot().iter("joint"):  # a chain, in order
        place = place + turn @ np.array(joint.find("origin").get("xyz").split() if joint.find("origin") is not None else [0] * 3, float)
        if joint.get("type") != "revolute":
            continue
        axis, angle = np.array(joint.find("axis").get("xyz").split(), float), next(values)
        cross = np.cross(np.eye(3), axis)
        turn = turn @ (np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)
    return place


@pytest.fixture(scope="module")
def grid(tmp_path_factory):
    folder = tmp_path_factory.mktemp("grid")
    ask(folder, "out", "--jobs", 1)
    return folder / "out"


def records(path):
    return [json.loads(line) for line in path.read_text().splitlines()[1:]]


def test_what_is_found_reaches_its_place_within_the_joints_limits(grid):
    robot, found = fcl_stpbv.Robot(str(ARM)), 0
    assert [record["job"] for record in records(grid)] == [[row] for row in range(4)]
    for record in records(grid):
        assert len(record["places"]) == 9
        for column, place in enumerate(record["places"]):
            if not place["feasible"]:
                assert place["conflict"]
                continue
            found += 1
            assert np.linalg.norm(tool_at(place["q"]) - target(record["job"][0], column)) < 2e-6  # the solver's tolerance is 1e-6
            assert np.all(robot.lower <= place["q"]) and np.all(place["q"] <= robot.upper)
    assert 4 < found < 36


def test_places_start_from_their_neighbours_or_from_the_tasks_starts_as_they_say(grid):
    search, task, ways = fcl_stpbv.PostureSearch(str(ARM)), json.loads(TASK.read_text()), set()
    for record in records(grid):
        places = record["places"]
        for column, place in enumerate(places):
            task["placements"][0]["target"]["position"] = target(record["job"][0], column).tolist()
            if not place["feasible"]:
                continue
            if place["start"] == "neighbour":
                sides = [places[i] for i in (column - 1, column + 1) if 0 <= i < 9 and places[i]["feasible"]]
                tries = [search.solve(json.dumps(task), start_from=side["q"]) for side in sides]
            else:
                tries = [search.solve(json.dumps(task), start=place["start"])]
            # The targets differ by rounding here, and so do the postures.
            assert any(posture["feasible"] and np.allclose(posture["q"], place["q"], atol=1e-3) for posture in tries)
            ways.add(place["start"])
    assert {"neighbour", 0} <= ways


def test_a_grid_gives_the_same_bytes_in_shards_and_in_other_processes(grid, tmp_path, cluster):
    for i in (2, 0, 1):
        ask(tmp_path, f"part{i}", "--shard", f"{i}/3")
    ask(tmp_path, "merged", "--merge", *(tmp_path / f"part{i}" for i in (1, 2, 0)))
    ask(tmp_path, "others", "--scheduler", cluster.address)
    assert (tmp_path / "merged").read_bytes() == (tmp_path / "others").read_bytes() == grid.read_bytes()


def test_without_neighbours_only_the_tasks_own_starts_count(grid, tmp_path):
    alone = ask(tmp_path, "alone", "--independent", "--jobs", 1)
    starts = {place["start"] for record in alone for place in record["places"]}
    assert starts == {0, 1}
    assert "neighbours" in batch("postures", ARM, TASK, "--grid", tmp_path / "grid.json", "--starts", 2, "--jobs", 1, "-o", tmp_path / "alone",
                                 status=2)


def test_placements_that_share_a_name_move_one_by_one_under_the_names_of_the_library():
    places = [{"link": "tool", "target": {"position": [i, 0, 0]}} for i in range(3)] + [{"link": "tool", "name": "tip", "target": {}}]
    task = json.dumps({"placements": places})
    axis = {"name": "up", "from": 0, "to": 1, "count": 2}
    grid = Placements(task, json.dumps({"axes": [{**axis, "move": {"tool#2": [0, 0, 1], "tip": [0, 2, 0]}}]}), "grid.json")
    moved = [placement["target"]["position"] for placement in json.loads(grid.text(0, 1))["placements"]]
    assert moved == [[0, 0, 0], [1, 0, 1], [2, 0, 0], [0, 2, 0]]
    with pytest.raises(fcl_stpbv.Error, match='got "tool", expected a placement of the task: tip, tool#1, tool#2, tool#3'):
        Placements(task, json.dumps({"axes": [{**axis, "move": {"tool": [0, 0, 1]}}]}), "grid.json")


def test_wrong_grids_are_refused_in_one_line(tmp_path):
    wrong = {"{": "is no JSON", "[]": "list of axes", '{"axes": []}': "list of axes", '{"axes": [3]}': "axes[0]: got 3"}
    for change, what in [({"move": {"nose": [1, 0, 0]}}, 'axes[1].move: got "nose", expected a placement of the task: tool'), ({"move": {}}, "axes[1].move"),
                         ({"move": {"tool": [1, 0]}}, "axes[1].move.tool"), ({"from": "0"}, "axes[1].from"), ({"to": 1e9}, "axes[1].to"),
                         ({"count": 0}, "axes[1].count"), ({"count": 2.5}, "axes[1].count"), ({"count": True}, "axes[1].count"),
                         ({"step": 1}, 'axes[1]: got "step"'), ({"name": 1}, "axes[1].name"), ({"base": 1}, "axes[1].base")]:
        wrong[json.dumps({"axes": [AXES[0], {**AXES[1], **change}]})] = what
    wrong[json.dumps({"axes": [{**AXES[0], "count": 1000}, {**AXES[1], "count": 1001}]})] = "1001000 places, expected at most 1000000"
    wrong[json.dumps({"axes": [{key: value for key, value in AXES[0].items() if key != "from"}]})] = "axes[0].from: is missing"
    wrong[json.dumps({"axes": AXES}).replace('"count"', '"count": 1, "count"', 1)] = "has the key 'count' twice; remove one"
    for grid, what in wrong.items():
        with pytest.raises(fcl_stpbv.Error) as refused:
            Placements(TASK.read_text(), grid, "grid.json")
        assert str(refused.value).startswith("grid.json") and what in str(refused.value)
    message = ask(tmp_path, "out", axes=[3], status=2)
    assert "grid.json: axes[0]: got 3, expected an object" in message and message.count("\n") == 1
    (tmp_path / "broken.json").write_bytes(b"\xff\xfe{")
    assert "broken.json" in batch("postures", ARM, TASK, "--grid", tmp_path / "broken.json", "-o", tmp_path / "out", status=2)
    assert "--grid" in batch("postures", ARM, TASK, "--independent", "-o", tmp_path / "out", status=2)
    (tmp_path / "other.json").write_text(TASK.read_text())
    assert "got 2" in batch("postures", ARM, TASK, tmp_path / "other.json", "--grid", tmp_path / "grid.json", "-o", tmp_path / "out", status=2)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("scene, task, row, rows, least", [("ladder", "climb", 2, 21, 15), ("fridge", "reach", 48, 100, 3)])
def test_the_robot_finds_postures_on_the_ladder_and_at_the_fridge(tmp_path, scene, task, row, rows, least):
    hrp2, folder = DATA / "hrp2_style/hrp2_style", DATA / scene
    batch("postures", f"{hrp2}.urdf", folder / f"{task}.json", "--grid", folder / f"{task}_grid.json", "--srdf", f"{hrp2}.srdf", "--obstacles",
          folder / f"{scene}.urdf", "--starts", 1, "--shard", f"{row}/{rows}", "-o", tmp_path / "out")
    (record,) = records(tmp_path / "out")
    assert record["job"] == [row] and sum(place["feasible"] for place in record["places"]) >= least

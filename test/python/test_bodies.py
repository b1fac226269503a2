"""What volumes a Robot's links get: its r, R, links and flat mean what the tools' options do, and give the same distances."""
import json
import os
import pathlib
import subprocess

import numpy as np
import pytest

import fcl_stpbv

DATA = pathlib.Path(os.environ.get("FCL_STPBV_DATA", pathlib.Path(__file__).parents[2] / "data"))
FILES = DATA / "hrp2_style/hrp2_style.urdf", DATA / "hrp2_style/hrp2_style.srdf"
REPORT = pathlib.Path(fcl_stpbv.__file__).parents[2] / "bin/urdf_collision_report"


@pytest.fixture(scope="module")
def wall(tmp_path_factory):
    """A flat mesh in front of the robot."""
    folder = tmp_path_factory.mktemp("wall")
    corners = [(x, y, z) for x in (1.0, 1.1) for y in (-1.0, 1.0) for z in (-1.0, 1.0)]
    (folder / "wall.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "f 1 2 4\nf 1 4 3\nf 5 7 8\nf 5 8 6\nf 1 5 6\nf 1 6 2\n"
                                     "f 3 4 8\nf 3 8 7\nf 1 3 7\nf 1 7 5\nf 2 6 8\nf 2 8 4\n")
    (folder / "wall.urdf").write_text("<robot name='wall'><link name='wall'><collision><geometry><mesh filename='wall.obj'/></geometry>"
                                      "</collision></link></robot>")
    return folder / "wall.urdf"


def reported(options, wall):
    """Distances of each checked pair of links, and of links and obstacles, in half_sitting."""
    command = [REPORT, FILES[0], "--srdf", FILES[1], "--obstacles", wall, "--pose", "half_sitting", "--samples", "1", "-q", "--format", "json"]
    done = subprocess.run([*map(str, command), *options], capture_output=True, text=True, timeout=120)
    assert done.returncode in (0, 1), done.stderr
    return {(pair["link1"], pair["link2"] or pair["obstacle"]): pair["distance"] for pair in json.loads(done.stdout)["pairs"] if pair["checked"]}


@pytest.mark.skipif(not REPORT.exists(), reason="urdf_collision_report is not built")
@pytest.mark.parametrize("options, given", [
    (["-r", "0.01"], {}),
    ([], {"r": "auto"}),
    (["-R", "5"], {"r": "auto", "R": 5}),
    (["-r", "0.003", "-R", "auto"], {"r": 0.003, "R": "auto"}),
    (["-r", "0.01", "--link", "LARM_LINK6=0.001,3", "--link", "HEAD_LINK1=0.02,20,0.03"],
     {"links": {"LARM_LINK6": (0.001, 3.0), "HEAD_LINK1": [0.02, 20, 0.03]}}),
    (["-r", "0.01", "--flat", "LARM_LINK6", "--flat", "obstacles"], {"flat": ["LARM_LINK6", "obstacles"]}),
    (["--flat", "obstacles"], {"r": "auto", "flat": "obstacles"})], ids=" ".join)
def test_a_robot_has_the_distances_of_the_report_with_the_same_options(options, given, wall):
    robot = fcl_stpbv.Robot(*FILES, wall, **given)
    q, usual = robot.configuration("half_sitting"), fcl_stpbv.Robot(*FILES, wall)
    expected, found = reported(options, wall), dict[tuple[str, ...], float]()
    for row, d in zip(robot.rows, robot.distances(q)):
        links = tuple(name.split("#")[0] for name in row.split(" - "))
        found[links] = min(d, found.get(links, np.inf))
    assert found.keys() == expected.keys()
    for links, d in found.items():
        assert d == pytest.approx(expected[links], abs=1e-9), links  # the report's digits
    if given:
        assert abs(robot.distances(q) - usual.distances(q)).max() > 1e-4


@pytest.mark.parametrize("search", [fcl_stpbv.PairSearch, fcl_stpbv.PostureSearch])
def test_searches_fit_the_radii_as_a_robot_does(search, tmp_path):
    # Two cubes of 2 cm, 4 mm apart; a link far away is between them in the tree. r fitted to them is 1 mm, so
    # their volumes do not meet.
    corners = [(x, y, z) for x in (-0.01, 0.01) for y in (-0.01, 0.01) for z in (-0.01, 0.01)]
    (tmp_path / "cube.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "f 1 2 4\nf 1 4 3\nf 5 7 8\nf 5 8 6\nf 1 5 6\nf 1 6 2\n"
                                       "f 3 4 8\nf 3 8 7\nf 1 3 7\nf 1 7 5\nf 2 6 8\nf 2 8 4\n")
    body = "<link name='{}'><collision><geometry><mesh filename='cube.obj'/></geometry></collision></link>"
    slide = ("<joint name='{}' type='prismatic'><parent link='{}'/><child link='{}'/><origin xyz='{} 0 0'/><axis xyz='0 1 0'/>"
             "<limit lower='0' upper='0.001' effort='1' velocity='1'/></joint>")
    urdf = tmp_path / "cubes.urdf"
    urdf.write_text("<robot name='cubes'>" + body.format("a") + body.format("m") + body.format("b") + slide.format("j", "a", "m", 1)
                    + slide.format("k", "m", "b", -0.976) + "</robot>")
    if search is fcl_stpbv.PairSearch:
        def meets(**given):
            pairs = search(urdf, **given)
            return pairs.sample(1, 0, 20)[0][0] > 0
    else:
        srdf = tmp_path / "cubes.srdf"
        srdf.write_text("<robot name='cubes'><disable_collisions link1='a' link2='m'/></robot>")

        def meets(**given):
            return not search(urdf, srdf, **given).solve('{"base": "fixed", "placements": [], "cost": {"towards": "start"}}')["feasible"]
    assert meets() and meets(r=0.01, R=10)
    assert not meets(r="auto") and not meets(r=0.0005, R="auto")
    for wrong, told in (({"r": "fitted"}, '^r: got "fitted"'), ({"R": "fitted"}, '^R: got "fitted"')):
        with pytest.raises(fcl_stpbv.Error, match=told):
            search(urdf, **wrong)


def test_a_model_for_needs_keeps_the_bodies_that_were_asked_for(wall):
    given = {"links": {"LARM_LINK6": (0.001, 3.0)}, "flat": ["obstacles"]}
    robot = fcl_stpbv.Robot(*FILES, wall, **given)  # type: ignore[arg-type]
    model, unmet = robot.model_for([])
    assert unmet == [] and model.rows == robot.rows
    np.testing.assert_allclose(model.distances(robot.neutral), robot.distances(robot.neutral), rtol=0, atol=1e-13)


@pytest.mark.parametrize("given, told", [
    ({"r": "fitted"}, '^r: got "fitted", expected a length .* or "auto"'), ({"R": "fitted"}, '^R: got "fitted"'),
    ({"links": {"HEAD_LINK1": (0.01,)}}, r'^links: "HEAD_LINK1": got 1 numbers, expected \(r, R\)'),
    ({"links": {"HEAD_LINK1": (2.0, 1.0)}}, "^links: .*R must be larger"),
    ({"links": {"HEAD_LINK1": (float("nan"), 1.0)}}, "^links: "), ({"links": {"HEAD_LINK1": (-1.0, 1.0)}}, "r of link 'HEAD_LINK1'"),
    ({"links": {"nobody": (0.01, 1.0)}}, "a link 'nobody' it does not have"),
    ({"flat": ["head_link"]}, "a link 'head_link' it does not have; did you mean 'HEAD_LINK0'"),
    ({"flat": "obstacles"}, "^flat: there are no obstacles"), ({"flat": ["HEAD_LINK1"], "links": {"HEAD_LINK1": (0.01, 1.0)}}, '^flat: "HEAD_LINK1"'),
    ({"r": 1.0, "R": 0.5}, "R: got 0.5")])
def test_options_of_bodies_that_make_no_sense_are_refused(given, told):
    with pytest.raises(fcl_stpbv.Error, match=told):
        fcl_stpbv.Robot(*FILES, **given)

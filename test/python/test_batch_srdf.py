"""SRDFs of a batch of proofs: what they leave out is proven, what they keep is kept; pairs with obstacles."""
import json
import xml.etree.ElementTree

import numpy as np

import fcl_stpbv
from test_batch import ARM, batch

PROVE = ["prove", ARM, "--boxes", "300", "--budget", "100", "--descents", "1", "--jobs", 1]
USERS = """<robot name="six_joint_arm"><!-- mine --><group_state name="up" group="all"><joint name="joint2" value="0.5"/></group_state>
    <disable_collisions link1="wrist1" link2="flange" reason="User"/><disable_collisions link1="upper_arm" link2="wrist1" reason="User"/>
    <disable_collisions link1="base" link2="flange" reason="Never"/></robot>"""


def scene(path, **obstacles):
    """A URDF of spheres of 5 cm at these places."""
    path.write_text('<robot name="scene"><link name="world"/>' + "".join(
        f'<link name="{name}"><collision><geometry><sphere radius="0.05"/></geometry></collision></link><joint name="{name}_place" type="fixed">'
        f'<origin xyz="{place}"/><parent link="world"/><child link="{name}"/></joint>' for name, place in obstacles.items()) + "</robot>")
    return path


def verdicts(path):
    """{names of a pair: whether its proof is complete}, from the lines only."""
    rounds: dict[tuple, list] = {}
    for record in map(json.loads, path.read_text().splitlines()[1:]):
        rounds.setdefault(tuple(record["job"][:2]), []).append(record)
    return {pair: not any(r["collision"] for r in some) and not any(r["open"] for r in some if r["job"][2] == max(o["job"][2] for o in some))
            for pair, some in rounds.items()}


def left_out(path):
    """{names of a pair, sorted: its reason}"""
    return {tuple(sorted((e.get("link1"), e.get("link2")))): e.get("reason") for e in xml.etree.ElementTree.parse(path).iter("disable_collisions")}


def test_an_srdf_leaves_out_what_is_proven_and_the_users_own_and_nothing_else(tmp_path):
    (tmp_path / "users.srdf").write_text(USERS)
    out, srdf = tmp_path / "out", tmp_path / "proven.srdf"
    batch(*PROVE, "-o", out, "--write-srdf", srdf, "--srdf", tmp_path / "users.srdf")
    proven = {tuple(sorted(pair)) for pair, is_proven in verdicts(out).items() if is_proven}
    users = {("flange", "wrist1"), ("upper_arm", "wrist1")}
    assert ("upper_arm", "wrist1") in proven and len(proven - users) >= 1 and len(proven) < len(verdicts(out))
    found = left_out(srdf)
    assert {pair for pair, reason in found.items() if reason == "Never"} == proven - users
    assert {pair for pair, reason in found.items() if reason == "User"} == users
    neighbours = ["base", "shoulder", "upper_arm", "forearm", "wrist1", "wrist2", "flange"]
    assert {pair for pair, reason in found.items() if reason == "Adjacent"} == {tuple(sorted(two)) for two in zip(neighbours, neighbours[1:])}
    assert set(found.values()) == {"Never", "User", "Adjacent"}
    text = srdf.read_text()
    assert "<!-- mine -->" in text and "Obstacles were not looked at" in text and "Each Never is proven" in text
    robot = fcl_stpbv.Robot(str(ARM), str(srdf))  # it loads, and all other pairs are checked
    assert {tuple(sorted(row.split(" - "))) for row in robot.rows} == {tuple(sorted(pair)) for pair in verdicts(out)} - set(found)
    assert robot.configuration("up")[1] == 0.5


def test_no_sample_contradicts_what_an_srdf_calls_never(tmp_path):
    batch(*PROVE, "-o", tmp_path / "out", "--write-srdf", tmp_path / "proven.srdf")
    never = {pair for pair, reason in left_out(tmp_path / "proven.srdf").items() if reason == "Never"}
    arm = fcl_stpbv.PairSearch(str(ARM))
    least = {tuple(sorted(pair)): found[1] for pair, found in zip(arm.pairs, arm.sample(11, 0, 3000))}
    assert never and all(least[pair] > 0 for pair in never)


def test_a_pair_named_twice_is_left_out_once():
    arm = fcl_stpbv.PairSearch(str(ARM))
    assert arm.srdf([3, 1, 3]) == arm.srdf([1, 3])


def test_what_is_out_of_reach_is_proven_clear_and_what_is_hit_is_not(tmp_path):
    # With all its bodies the arm reaches less than 1.1 m from the shoulder at 0.26 m. The far sphere is 3 m
    # away, the near one is in its way.
    around = scene(tmp_path / "scene.urdf", far="0 3 0.26", near="0.5 0 0.26")
    out, srdf = tmp_path / "out", tmp_path / "proven.srdf"
    batch(*PROVE, "--obstacles", around, "-o", out, "--write-srdf", srdf)
    moving = ["shoulder", "upper_arm", "forearm", "wrist1", "wrist2", "flange"]
    of = verdicts(out)
    assert all(of[link, "obstacle far"] for link in moving) and ("base", "obstacle far") not in of
    assert not of["forearm", "obstacle near"] and not of["flange", "obstacle near"] and of["shoulder", "obstacle near"]
    assert "flange and obstacle far" in srdf.read_text() and "flange and obstacle near" not in srdf.read_text()
    assert set(left_out(srdf).values()) == {"Never", "Adjacent"}  # obstacles do not belong into it
    search = fcl_stpbv.PairSearch(str(ARM), str(around))
    assert len(search.pairs) == search.link_pairs + 12
    hits = {pair: found[0] for pair, found in zip(search.pairs, search.sample(5, 0, 500))}
    assert any(hits.values()) and not any(hits[pair] for pair, is_proven in of.items() if is_proven)
    q = next(r["collision"] for r in map(json.loads, out.read_text().splitlines()[1:]) if r["job"][:2] == ["flange", "obstacle near"])
    assert np.all(np.isfinite(q)) and len(q) == 6


def test_obstacles_travel_with_the_robot(tmp_path, here_or_there):
    around = scene(tmp_path / "scene.urdf", near="0.5 0 0.26")
    sample = ["sample", ARM, "--obstacles", around, "--blocks", 3, "--count", 40]
    batch(*sample, *here_or_there, "-o", tmp_path / "out")
    search = fcl_stpbv.PairSearch(str(ARM), str(around))
    records = [json.loads(line) for line in (tmp_path / "out").read_text().splitlines()[1:]]
    assert [record["least"] for record in records] == [[pair[1] for pair in search.sample(1, block, 40)] for block in range(3)]


def test_wrong_srdfs_and_scenes_are_refused_before_anything_is_computed(tmp_path):
    out = tmp_path / "out"
    (tmp_path / "bad.srdf").write_text("<robot")
    around = scene(tmp_path / "scene.urdf", near="0.5 0 0.26")
    for arguments, what in [(["--write-srdf", tmp_path / "a.srdf", "--srdf", tmp_path / "bad.srdf"], "bad.srdf"),
                            (["--write-srdf", tmp_path / "a.srdf", "--srdf", tmp_path / "no.srdf"], "no.srdf"),
                            (["--srdf", tmp_path / "bad.srdf"], "--write-srdf"),
                            (["--obstacles", tmp_path / "no.urdf"], "no.urdf")]:
        message = batch(*PROVE, *arguments, "-o", out, status=2)
        assert what in message and message.count("\n") == 1 and not out.exists()
    batch(*PROVE, "-o", out)
    assert "bundle" in batch(*PROVE, "--obstacles", around, "-o", out, status=2)  # another batch
    assert "--write-srdf" in batch(*PROVE, "-o", out, "--write-srdf", tmp_path / "no/a.srdf", status=2) and out.exists()

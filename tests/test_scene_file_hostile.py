"""Hundreds of hostile and malformed scene files come to one line each, with file, line and field; none is run."""

from __future__ import annotations

import json
import os
import re
import socket
import tomllib
from pathlib import Path

import pytest
from command_line import assert_refused
from scene_files import TEMPLATE, WATCH, changed, leaves, read, spatial

from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene import Scene
from painleve.mechanics.scene_file import build
from painleve.mechanics.scene_file.document import MAX_BYTES
from painleve.mechanics.scene_file.lines import field_lines, words_of
from painleve.mechanics.scene_file.work import TooMuchWork, limited_calls


def refusal(text: str) -> str:
    """The line by which a text is refused."""
    with pytest.raises(InputError) as caught:
        read(text)
    return checked(str(caught.value))


def checked(message: str) -> str:
    assert message.isprintable(), ascii(message)
    assert message.startswith("rod.toml")
    assert len(message) < 1200
    return message


WRONG = (
    '""',
    "-1",
    "0.5",
    "true",
    "1979-05-27",
    "07:32:00",
    "[]",
    "[[1], [[2]]]",
    "{}",
    "{ a = 1 }",
    "nan",
    "-inf",
    "1e400",
    "1e-9999",
    "9999999999e99999999",
    "0x" + "f" * 1100,
    '"9**9**9"',
    '"x**(10**9)"',
    "\"__import__('os')\"",
    '"1/0"',
    '"x.__class__"',
    '"lambda: 1"',
    '"[x for x in (1,)]"',
    '"f\\u0000"',
    '"\\u001b[31mred"',
    '"\\u202eevil"',
    '"\\u0430"',
    '"' + "(" * 300 + '"',
    '"' + "x+" * 2000 + 'x"',
    '"x := 1"',
    "\"'a' * 9\"",
    '"x if x else y"',
    '"x;y"',
    '"$\\\\input{a}$"',
)


STRIDE = 6


@pytest.mark.parametrize("value", WRONG)
def test_a_wrong_value_in_any_field_is_refused_on_the_line_of_that_field(value):
    """Fields and tables of the template in turn, each with several of the values."""
    harmless = {'""', "-1", "0.5", "{}", "[]", "1e400", '"x;y"', '"x := 1"', "\"'a' * 9\"", '"f"', '"9**9**9"'}
    refused = 0
    for path in list(leaves(tomllib.loads(TEMPLATE)))[WRONG.index(value) % STRIDE :: STRIDE]:
        text = changed(path, value)
        try:
            scene = read(text)
        except InputError as error:
            message, refused = checked(str(error)), refused + 1
            found = re.match(r"rod\.toml, line (\d+)", message)
            if found:
                row = text.splitlines()[int(found[1]) - 1]
                names = [str(part) for part in path if isinstance(part, str)]
                assert any(name in row for name in names) or message.count("declared") or path[0] in message, message
        else:
            texts = [scene.sentence, scene.source, *(c.unit + c.sentence + c.latex for c in scene.coordinates)]
            assert value in harmless or all(t.isprintable() and "$" not in t for t in texts)
    assert refused > 8


def test_a_field_that_is_missing_or_unknown_is_refused_by_name():
    required = [
        ("name",),
        ("sentence",),
        ("coordinates",),
        ("mechanics",),
        ("contact",),
        ("contact", "height"),
        ("mechanics", "kinetic_energy"),
        ("friction", "mu"),
        ("friction", "kind"),
        ("parameters", "m", "unit"),
        ("parameters", "m", "default"),
        ("coordinates", "x", "sentence"),
        ("states", "paradox", "sentence"),
        ("outline", "floor"),
        ("keys", "slip", "unit"),
    ]
    for path in required:
        assert path[-1] in refusal(changed(path, None))
    for old, new, near in (
        ("sentence =", "sentense =", "sentence"),
        ("height =", "hight =", "height"),
        ("[placement]", "[placment]", "placement"),
        ("gravity*y", "gravty*y", "gravity"),
        ('kind = "segment"', 'kind = "segmant"', "segment"),
    ):
        assert f"did you mean {near}?" in refusal(TEMPLATE.replace(old, new, 1))


def test_a_file_cut_off_anywhere_is_a_scene_or_is_refused():
    cut = [TEMPLATE[:size] for size in range(0, len(TEMPLATE), 23)]
    kinds = set()
    for text in cut:
        try:
            kinds.add(type(read(text)))
        except InputError as error:
            kinds.add(type(error))
            checked(str(error))
    assert kinds == {Scene, InputError}
    assert len(cut) > 150


NAMES = (
    "lambda",
    "class",
    "None",
    "__import__",
    "_x",
    "2x",
    "x y",
    "x-y",
    "x.y",
    "",
    "é",
    "а",
    "ｘ",
    "x\u200b",
    "x\u0000",
    "x\n",
    "\u001b[0m",
    "sin",
    "atan2",
    "pi",
    "t",
    "nan",
    "oo",
    "u_x",
    "u_",
    "x" * 33,
    "../x",
    "x/y",
    "x;y",
    "$x$",
    "%s",
    "{x}",
    "gamma",
    "eps",
    "verdict",
    "m_exact",
    "excess_Aeps_A_lower",
)


@pytest.mark.parametrize("table", ["coordinates", "parameters", "keys", "states"])
def test_a_name_that_would_mean_something_elsewhere_is_refused(table):
    """Python's words, functions, velocities, variables of datasets, paths, escapes, letters that look alike."""
    allowed = {
        "states": {
            "sin",
            "atan2",
            "pi",
            "t",
            "nan",
            "oo",
            "u_x",
            "u_",
            "gamma",
            "eps",
            "verdict",
            "m_exact",
            "excess_Aeps_A_lower",
        }
    }
    for name in NAMES:
        quoted = json.dumps(name)
        head = f"[{table}.{quoted}]" if table == "states" else f"[{table}]\n{quoted} = "
        body = '\nsentence = "s"\n' if table == "states" else '{ unit = "1", sentence = "s", default = 1 }\n'
        if table == "coordinates":
            body = body.replace(", default = 1", "")
        text = TEMPLATE.replace(
            f"[{table}.sliding]" if table == "states" else f"[{table}]\n",
            head + body + ("[states.sliding]" if table == "states" else ""),
        )
        if name in allowed.get(table, ()):
            assert read(text).state(name).sentence == "s"
        else:
            assert re.match(rf"rod\.toml, line \d+, {table}\.", refusal(text))
    assert refusal(TEMPLATE.replace('name = "my_rod"', 'name = "../../rod"')).startswith("rod.toml, line 8, name: ")


HEIGHT = 'height = "y - l*sin(theta)"'
HOSTILE = {
    "not TOML": "name = ",
    "not TOML at all": "%PDF-1.4\n\u0394",
    "empty": "",
    "control characters": "name = \u0001",
    "a key twice": "name = 'a'\nname = 'b'",
    "a table twice": "[friction]\n[friction]",
    "deep arrays": "a = " + "[" * 10_000,
    "deep tables": "a = " + "{a=" * 5000,
    "deep closed arrays": "a = " + "[" * 5000 + "]" * 5000,
    "a key of many parts": ".".join("a" * 10_000) + " = 1",
    "a header of many parts": "[" + ".".join("a" * 10_000) + "]",
    "an endless string": 'name = """' + "a\n" * 10_000,
    "endless strings": "'''\"\"\"" * 4000,
    "escaped quotes": 'name = """' + '\\"""' * 5000,
    "a huge number": "name = " + "9" * 30_000,
    "a huge hexadecimal number": "name = 0x" + "f" * 30_000,
    "a huge exponent": "name = 1e" + "9" * 30_000,
    "many tables": "".join(f"[a{i}]\n" for i in range(4000)),
    "an array of tables": TEMPLATE.replace("[friction]", "[[friction]]"),
    "coordinates as an array": "[[coordinates]]\nname = 'x'\n",
    "a power tower": TEMPLATE.replace("m*gravity*y", "9**9**9**9*y"),
    "powers of sums": TEMPLATE.replace("m*(u_x**2", "(x+y+theta+1)**60*m*(u_x**2"),
    "powers of powers": TEMPLATE.replace("m*gravity*y", "((((y+1)**64)**64)**64)**64"),
    "a kinetic energy that is not quadratic": TEMPLATE.replace("u_theta**2", "u_theta**3"),
    "a kinetic energy with a constant": TEMPLATE.replace("u_theta**2", "u_theta**2 + 1"),
    "a kinetic energy of a function": TEMPLATE.replace("u_theta**2", "sin(u_theta)"),
    "a quotient of velocities": TEMPLATE.replace("u_theta**2", "u_theta**3/u_x"),
    "M too small": changed(("mechanics",), '{ M = [["m"]] }'),
    "M ragged": changed(("mechanics",), '{ M = [["m", 0, 0], [0, "m"], [0, 0, "I"]] }'),
    "M skew": changed(("mechanics",), '{ M = [["m", "x", 0], [0, "m", 0], [0, 0, "I"]] }'),
    "M of velocities": changed(("mechanics",), '{ M = [["u_x", 0, 0], [0, "m", 0], [0, 0, "I"]] }'),
    "M and an energy": TEMPLATE.replace("# M =", "M ="),
    "a force too short": TEMPLATE.replace("potential =", "# ").replace("# force = [0, ", "force = ["),
    "a force and a potential": TEMPLATE.replace("# force =", "force ="),
    "a height without coordinates": TEMPLATE.replace(HEIGHT, 'height = "l"'),
    "a height that is not smooth": TEMPLATE.replace(HEIGHT, 'height = "y - abs(x)"'),
    "the root of a square": TEMPLATE.replace(HEIGHT, 'height = "y - sqrt(x**2)"'),
    "a height and g": TEMPLATE.replace("[contact]", "[contact]\ng = 'y'"),
    "two displacements for a segment": TEMPLATE.replace('"x - l*cos(theta)"\n', '["x", "y"]\n'),
    "a disc in the plane": TEMPLATE.replace('"segment"', '"disc"', 1).replace('kind = "segment"', 'kind = "disc"'),
    "a polygon of two vertices": spatial('kind = "polygon"\nvertices = [[1, 0], [0, 1]]'),
    "a polygon without pairs": spatial('kind = "polygon"\nvertices = [1, 2, 3]'),
    "an ellipse without an angle": spatial('kind = "ellipse"\nmu_1 = 1\nmu_2 = 2'),
    "a default that uses itself": TEMPLATE.replace('"m*l**2/3"', '"I"'),
    "a default that uses a later one": TEMPLATE.replace('"m*l**2/3"', '"mu*m"'),
    "a key that nothing uses": TEMPLATE.replace("omega = {", 'idle = { unit = "1", sentence = "s" }\nomega = {'),
    "a rule for no coordinate": TEMPLATE.replace('theta = "omega"', 'psi = "omega"'),
    "a state of no key": TEMPLATE.replace('parameters = { mu = "4/3" }', 'parameters = { nu = "4/3" }'),
    "seven coordinates": TEMPLATE.replace(
        "[parameters]", "".join(f'x{i} = {{ unit = "m", sentence = "s" }}\n' for i in range(4)) + "[parameters]"
    ),
}


@pytest.mark.parametrize("text", HOSTILE.values(), ids=HOSTILE.keys())
def test_a_hostile_text_is_refused_in_one_line(text):
    refusal(text)


HEAVY = TEMPLATE.replace("kinetic_energy =", "# ").replace(
    "# M = ",
    'M = [["9 + sin(x*y)", "cos(x - theta)", "x"], ["cos(x - theta)", "9 + y", "cos(y - theta)"], '
    '["x", "cos(y - theta)", "9 + theta"]]\n# ',
)


@pytest.mark.parametrize(
    ("limit", "most", "reason"),
    [("MOST_CALLS", 100_000, "takes too much algebra"), ("MOST_NODES", 500, r"have \d+ numbers, .*, more than 500")],
)
def test_algebra_stops_at_its_limit_and_the_same_file_is_read_within_it(limit, most, reason, monkeypatch):
    """Counted in calls and not in seconds: a busy machine refuses nothing."""
    monkeypatch.setattr(build, limit, most)
    assert re.search(reason, refusal(HEAVY + f"# {limit}"))
    monkeypatch.undo()
    assert read(HEAVY + f"# {limit}").dimension == 3


def test_the_watch_sees_what_it_has_to_see(tmp_path):
    WATCH.on, WATCH.seen = True, []
    exec("pass")
    (tmp_path / "x").touch()
    (tmp_path / "x").read_text()
    WATCH.on = False
    assert {event.split()[0] for event in WATCH.seen} >= {"exec", "open"}


def test_the_line_of_a_field_is_found_whatever_way_it_is_written():
    text = (
        """# comment with [brackets] and a = 'quote
"name" = 'x' # [not a table]
friction.kind = '''
[looks like a table]
'''
[parameters]
"m".unit = "kg" ; l = 1
""".replace(" ; ", "\n")
        + """
  [ states . "a b" ]
keys = { theta = "1", slip = 2 }
M = [ [1, 2], # first
      [3,
       4] ]
[[list]]
a = \"\"\"[\\\"\"\"\"
[[list]]
b = 1979-05-27 07:32:00
"""
    )
    tomllib.loads(text)
    lines = field_lines(words_of(text))
    expected = {
        ("name",): 2,
        ("friction", "kind"): 3,
        ("parameters",): 6,
        ("parameters", "m", "unit"): 7,
        ("parameters", "l"): 8,
        ("states", "a b"): 10,
        ("states", "a b", "keys", "slip"): 11,
        ("states", "a b", "M", 0, 1): 12,
        ("states", "a b", "M", 1): 13,
        ("states", "a b", "M", 1, 1): 14,
        ("list", 0, "a"): 16,
        ("list", 1, "b"): 18,
    }
    assert {path: lines.get(path) for path in expected} == expected


def test_every_field_of_the_template_has_its_line():
    lines = field_lines(words_of(TEMPLATE))
    rows = TEMPLATE.splitlines()
    for path in leaves(tomllib.loads(TEMPLATE)):
        name = next(part for part in reversed(path) if isinstance(part, str))
        assert name in rows[lines[path] - 1]


def paths(folder: Path) -> dict[str, str | Path]:
    """What is not a file of text, by what it is."""
    (folder / "bytes.toml").write_bytes(b"name = 'a'\nsentence = '\xff\xfe'")
    (folder / "nul.toml").write_bytes(b"name = 'a\x00'")
    (folder / "large.toml").write_bytes(b"#" * (MAX_BYTES + 1))
    (folder / "folder.toml").mkdir()
    (folder / "loop.toml").symlink_to(folder / "loop.toml")
    (folder / "link.toml").symlink_to("/dev/zero")
    os.mkfifo(folder / "pipe.toml")
    listener = socket.socket(socket.AF_UNIX)
    os.chdir(folder)
    listener.bind("socket.toml")
    listener.close()
    names = ["bytes", "nul", "large", "folder", "loop", "link", "pipe", "socket", "missing"]
    found: dict[str, str | Path] = {name: folder / f"{name}.toml" for name in names}
    return found | {
        "a device": "/dev/zero",
        "NUL in the name": "a\0.toml",
        "an escape": "\x1b[31m.toml",
        "a long name": "x" * 5000 + ".toml",
        "a lone surrogate": "\udc80.toml",
    }


WHY = dict.fromkeys(("folder", "link", "pipe", "socket", "a device"), "not a file") | {
    "bytes": "line 2: the file is not UTF-8",
    "nul": "not TOML",
    "large": "larger than",
    "loop": "symbolic links",
    "missing": "No such file",
    "a long name": "too long",
}


def test_what_is_not_a_file_of_text_is_refused_at_once(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, path in paths(tmp_path).items():
        with pytest.raises(InputError) as caught:
            load_scene(path)
        assert str(caught.value).isprintable(), name
        assert WHY.get(name, "cannot be read") in str(caught.value), name
        assert len(str(caught.value)) < 500
    with pytest.raises(InputError, match="line 2: the file is not UTF-8"):
        load_scene(tmp_path / "bytes.toml")


def test_a_hostile_file_on_the_command_line_leaves_one_line_and_no_file(tmp_path, monkeypatch, capsys):
    sentinel = tmp_path / "sentinel"
    attack = f"__import__('pathlib').Path('{sentinel}').touch()"
    for old in ("m*gravity*y", "m*l**2/3", "y - l*sin(theta)", "l*sin(theta)", "atan(2)", "my_rod"):
        (tmp_path / "rod.toml").write_text(TEMPLATE.replace(f'"{old}"', f'"{attack}"'))
        for command in (["derive", "rod.toml"], ["classify", "rod.toml", "--state", "paradox"]):
            assert_refused(command, capsys, tmp_path, monkeypatch)
    assert not sentinel.exists()


def test_a_byte_order_mark_and_windows_line_ends_are_no_fault(tmp_path):
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + TEMPLATE.replace("\n", "\r\n").encode())
    assert load_scene(path).inertia == read(TEMPLATE).inertia


class Finalised:
    def __del__(self) -> None:
        """Called when the object goes: whatever is raised here is dropped."""


def work() -> None:
    """One call."""


def swallow_in_a_finaliser(reached: list[str]) -> None:
    thing = Finalised()
    work()
    work()
    del thing  # one call too many, where nothing can be raised
    reached.append("after")
    work()


def swallow_in_a_generator(reached: list[str]) -> None:
    half_way = (work() for _ in range(2))
    next(half_way)  # two calls: its own and work's
    del half_way  # one call too many, where nothing can be raised
    reached.append("after")
    work()


@pytest.mark.parametrize("swallow", [swallow_in_a_finaliser, swallow_in_a_generator])
def test_the_budget_of_calls_holds_where_python_drops_the_refusal(swallow):
    """In a finaliser nothing can be raised: Python drops it, and the hook that raised it."""
    reached: list[str] = []
    with pytest.raises(TooMuchWork), limited_calls(3):
        swallow(reached)
    assert reached == ["after"]

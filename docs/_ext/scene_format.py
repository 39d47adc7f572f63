"""The scene format, a page per topic, from `unipbd schema`, `unipbd check` and the scenes of the repository.

Types, defaults and descriptions come from the schema. Ranges are what the checker itself says about values that
are far too small or too large. Examples come from shipped scenes; others are tried with the checker.
"""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

TOPICS = {
    "world": ("The world and its solver", ["", "domain", "environment", "shaking", "solver", "view"]),
    "materials": ("Materials", ["liquid", "gas", "smoke", "solid"]),
    "particles": ("Where particles start, come and go",
                  ["block", "disc", "points", "wave", "emitter", "injector", "heater", "sink"]),
    "walls": ("Walls", ["tank", "obstacle", "half_plane"]),
    "bodies": ("Bodies, joints, ropes", ["body", "joint", "rope", "contacts"]),
    "gauges": ("Gauges", ["gauge"]),
    "checks": ("Expectations and comparison with the papers", ["expect", "legacy"]),
}
UNIT = re.compile(r"\[((?:kg|m|s|N|J|1|degrees|rad|K)(?:[ /^*0-9a-z]*))\]")
RANGE = re.compile(r"(must (?:be|not be)[^,]*?)(?:, found.*|, but.*)?$")
PROBLEM = re.compile(r"^error: (\S+): (.*)$", re.MULTILINE)
PROBES = {"number": ("-1", "0", "1e30"), "integer": ("-1", "0", "4000000000")}
# What stands for a value of this type where no scene has one; the checker has the last word.
TRIED = {
    "number": ("1.0", "0.5", "0.1", "2.0", "10.0"), "integer": ("1", "2", "8"), "boolean": ("true",),
    "string": ('"water"', '"#3399ff"'), "array of 2 numbers": ("[0.0, 1.0]", "[1.0, 2.0]", "[0.5, 0.5]"),
    "array of integers": ("[0]",), "array of strings": ('["water"]',), "array of points": ("[[0.55, 3.05]]",),
    "array of numbers": ("[0.0, 0.5, 0.0]",),
}
# Examples by the name of the key, or by its whole path.
NAMED = {
    "name": ('"floor"',), "other": ('"raft"',),
    "region": ("{ center = [5.0, 6.0], radius = 0.5 }",), "velocities": ("[[0.0, -1.0]]",),
    "file": ('"piston.csv"',), "line": ("[[1.5, 0.0], [1.5, 2.0]]",), "time": ("[0.0, 1.0, 2.0]",),
    "body.motion.table": ("{ time = [0.0, 1.0, 2.0], x = [0.0, 0.5, 0.0] }",),
    "shaking.table": ("{ time = [0.0, 1.0, 2.0], ax = [0.0, 0.5, 0.0] }",),
    "path": ("[{ time = 1.0, offset = [0.5, 0.0] }, { time = 2.0, offset = [0.0, 0.0] }]",),
}


# Ranges that depend on other keys, so that probes of one scene do not tell them.
DEPENDS = {"wave.amplitude": "one spacing to a tenth of the wavelength"}


@dataclass
class Key:
    name: str
    kind: str
    node: dict[str, Any]
    required: bool
    description: str
    unit: str = ""
    default: str = ""
    range: str = ""
    example: str = ""
    words: list[tuple[str, str]] = field(default_factory=list)


class Schema:
    """The schema with references followed."""

    def __init__(self, unipbd: Path) -> None:
        self.root = json.loads(subprocess.run([unipbd, "schema"], check=True, capture_output=True, text=True).stdout)

    def resolve(self, node: dict[str, Any]) -> dict[str, Any]:
        """What a reference stands for; what stands beside the reference goes first."""
        while "$ref" in node:
            target = self.root["$defs"][node["$ref"].rsplit("/", 1)[1]]
            node = {**target, **{key: value for key, value in node.items() if key != "$ref"}}
        return node

    def options(self, node: dict[str, Any]) -> list[dict[str, Any]]:
        node = self.resolve(node)
        return [self.resolve(option) for option in node.get("oneOf", node.get("anyOf", []))]

    def kind(self, node: dict[str, Any]) -> str:
        node = self.resolve(node)
        if "const" in node or "enum" in node:
            return "word"
        options = self.options(node)
        if options:
            return " or ".join(dict.fromkeys(self.kind(option) for option in options))
        if node.get("type") == "array":
            inner = self.kind(node.get("items", {}))
            count = node.get("minItems")
            exact = f"{count} " if count is not None and count == node.get("maxItems") else ""
            plural = {"any": "values", "array of 2 numbers": "points"}.get(inner, inner + "s")
            return f"array of {exact}{plural}"
        if node.get("type") == "object":
            return "table"
        return str(node.get("type", "any"))

    def words(self, node: dict[str, Any]) -> list[tuple[str, str]]:
        node = self.resolve(node)
        if "const" in node:
            return [(node["const"], node.get("description", ""))]
        if "enum" in node:
            return [(word, "") for word in node["enum"]]
        if node.get("type") == "array":
            return self.words(node.get("items", {}))
        return [word for option in self.options(node) for word in self.words(option)]

    def tables(self) -> dict[str, tuple[dict[str, Any], bool]]:
        """The top-level tables by name, with whether there may be several."""
        found = {}
        for name, node in self.root["properties"].items():
            seen = self.resolve(node)
            many = seen.get("type") == "array"
            inner = self.resolve(seen.get("items", {})) if many else seen
            if "properties" in inner:
                found[name] = ({**inner, "description": node.get("description", inner.get("description", ""))}, many)
        return found

    def keys(self, table: dict[str, Any]) -> list[Key]:
        required = table.get("required", [])
        made = []
        for name, node in table["properties"].items():
            seen = self.resolve(node)
            text = node.get("description", seen.get("description", ""))
            key = Key(name, self.kind(node), seen, name in required, text)
            unit = UNIT.search(text)
            key.unit = unit[1] if unit else ""
            key.words = self.words(node)
            if "default" in node and not isinstance(node["default"], dict):
                key.default = toml(node["default"])
            made.append(key)
        return sorted(made, key=lambda key: not key.required)


def toml(value: Any) -> str:
    """A value as TOML writes it."""
    if isinstance(value, dict):
        return "{}" if not value else "{ " + ", ".join(f"{key} = {toml(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


class Scenes:
    """The shipped scenes: where examples come from, and what probes are made in."""

    def __init__(self, folder: Path) -> None:
        paths = sorted(folder.glob("*.toml")) + sorted(folder.glob("seed/*.toml"))
        self.texts = {path: tomllib.loads(path.read_text(encoding="utf-8")) for path in paths}

    def entries(self, path: str) -> Iterator[tuple[Path, str, dict[str, Any]]]:
        """Every table at a path such as body.motion: the scene, its place there, and what it holds."""

        def walk(node: Any, left: list[str], place: list[str]) -> Iterator[tuple[str, dict[str, Any]]]:
            if isinstance(node, list):
                for index, entry in enumerate(node):
                    yield from walk(entry, left, [*place, str(index)])
            elif isinstance(node, dict) and not left:
                yield ".".join(place), node
            elif isinstance(node, dict) and left[0] in node:
                yield from walk(node[left[0]], left[1:], [*place, left[0]])

        for scene, text in self.texts.items():
            for place, entry in walk(text, path.split(".") if path else [], []):
                yield scene, place, entry

    def example(self, path: str, key: str) -> str:
        """A value that a shipped scene gives to a key, the shortest."""
        return min((toml(entry[key]) for _, _, entry in self.entries(path) if key in entry), key=len, default="")

    def place(self, path: str) -> tuple[Path, str] | None:
        """The smallest scene that has this table, and the table's place in it."""
        having = [(scene, place) for scene, place, _ in self.entries(path)]
        return min(having, key=lambda found: found[0].stat().st_size, default=None)


class Checker:
    """What the command says about a value of a key, in a scene that has the table."""

    def __init__(self, unipbd: Path, scenes: Scenes, folder: Path) -> None:
        self.unipbd, self.scenes, self.folder = unipbd, scenes, folder

    def place(self, path: str, many: bool) -> tuple[Path, str]:
        """A scene with this table, and the table's place in it: a shipped one, or one made for it."""
        shipped = self.scenes.place(path)
        if shipped is not None:
            return shipped
        plain, _ = self.scenes.place("liquid") or (None, "")
        assert plain is not None
        scene = self.folder / f"with_{path}.toml"
        head = f"[[{path}]]" if many else f"[{path}]"
        scene.write_text(plain.read_text(encoding="utf-8") + f"\n{head}\n{MADE.get(path, '')}\n", encoding="utf-8")
        return scene, f"{path}.0" if many else path

    def problems(self, path: str, many: bool, key: str, value: str) -> list[str]:
        """Messages about this key where it has this value, and no other."""
        scene, place = self.place(path, many)
        change = f"{place}.{key}={value}" if place else f"{key}={value}"
        command = [self.unipbd, "info", scene, "--json", "--set", change]
        said = subprocess.run(command, capture_output=True, text=True, encoding="utf-8").stderr
        return [message for name, message in PROBLEM.findall(said) if key in name]

    def fill(self, path: str, many: bool, key: Key) -> None:
        """Range and example of a key."""
        said = [self.limit(path, many, key, probe) for probe in PROBES.get(key.kind.split(" or ")[-1], ())]
        key.range = DEPENDS.get(f"{path}.{key.name}") or narrowest(list(dict.fromkeys(text for text in said if text)))
        key.example = self.scenes.example(path, key.name)
        if not key.example and key.default not in ("", '""', "[]"):
            key.example = key.default
        if not key.example and key.words:
            key.example = json.dumps(key.words[0][0])
        if not key.example:
            tried = NAMED.get(f"{path}.{key.name}", NAMED.get(key.name, ())) + TRIED.get(key.kind, ())
            fine = (value for value in tried if not self.problems(path, many, key.name, value))
            key.example = next(fine, tried[0] if tried else "")

    def limit(self, path: str, many: bool, key: Key, probe: str) -> str:
        for message in self.problems(path, many, key.name, probe):
            found = RANGE.search(message)
            if found:
                text = found[1].replace("must not be negative", "0 or more").replace("must not be", "not")
                return text.removeprefix("must be ").replace("greater than 0", "above 0")
        return ""


def narrowest(said: list[str]) -> str:
    """One range of what the checker said: the tighter of two says all."""
    bounds = [text for text in said if text.startswith("from ")]
    if len(bounds) == 1 and set(said) <= {bounds[0], "above 0", "0 or more"}:
        return bounds[0].replace("from 0 to", "above 0 to") if "above 0" in said else bounds[0]
    return "; ".join(said)


# Tables that no shipped scene has, with what they need.
MADE = {
    "solid": 'name = "points"',
    "points": 'material = "water"\npositions = [[0.55, 3.0]]',
    "wave": "level = 4.0\namplitude = 0.1\nwavelength = 4.0",
    "disc": 'material = "water"\ncenter = [5.0, 6.0]\nradius = 0.5',
    "sink": "region = { center = [5.0, 6.0], radius = 0.5 }",
    "heater": "region = { center = [5.0, 6.0], radius = 0.5 }",
    "injector": 'material = "water"\nregion = { center = [5.0, 6.0], radius = 0.5 }\nrate = 10.0',
}


def cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")


def code(text: str) -> str:
    return f"`{text}`" if text else ""


def shown(key: Key) -> str:
    """Default, or that the key must be there."""
    return "**required**" if key.required else code(key.default) if key.default not in ("", '""') else "—"


def short(value: str, most: int = 48) -> str:
    return value if len(value) <= most else value[: most - 1].rsplit(",", 1)[0] + ", …"


def rows(keys: list[Key]) -> str:
    lines = ["| key | type | unit | default | range | example | what it is |", "|---|---|---|---|---|---|---|"]
    for key in keys:
        words = ", ".join(f"`\"{word}\"`" for word, _ in key.words)
        limit = words or key.range
        bound = cell(limit) if limit else "any" if "number" in key.kind else ""
        meaning = cell(key.description)
        told = "; ".join(f"`\"{word}\"`: {cell(text)}" for word, text in key.words if text)
        meaning += f" {told}" if told else ""
        lines.append(f"| `{key.name}` | {key.kind} | {key.unit} | {shown(key)} | {bound} | "
                     f"{code(cell(short(key.example)))} | {meaning} |")
    return "\n".join(lines)


def inner_tables(schema: Schema, keys: list[Key], seen: set[str]) -> list[tuple[str, dict[str, Any], bool]]:
    """Tables within a table."""
    found = []
    for key in keys:
        many = key.node.get("type") == "array"
        node = schema.resolve(key.node.get("items", {})) if many else key.node
        if "properties" in node and key.name not in seen:
            found.append((key.name, node, many))
    return found


def section(schema: Schema, checker: Checker, path: str, table: dict[str, Any], many: bool, depth: int) -> str:
    """One table: heading, description, rows, and the tables within it."""
    keys = schema.keys(table)
    if path == "":
        tables = set(schema.tables())
        keys = [key for key in keys if key.name not in tables]
    with ThreadPoolExecutor() as pool:
        list(pool.map(lambda key: checker.fill(path, many, key), keys))
    mark = f"[[{path}]]" if many else f"[{path}]"
    heading = "Top-level keys" if path == "" else f"`{mark}`"
    label = f"(scene-{path.replace('.', '-') or 'top'})="
    parts = [f"{label}\n{'#' * depth} {heading}", cell(table.get("description", "")), rows(keys)]
    if path:
        for name, node, several in inner_tables(schema, keys, set()):
            parts.append(section(schema, checker, f"{path}.{name}", node, several, depth + 1))
    return "\n\n".join(parts)


def write(unipbd: Path, root: Path, out: Path) -> list[str]:
    """Writes the pages; returns keys without an example, which are a fault of this generator."""
    schema, scenes = Schema(unipbd), Scenes(root / "scenes")
    checker = Checker(unipbd, scenes, out)
    tables = schema.tables()
    placed = {name for _, names in TOPICS.values() for name in names}
    topics = {**TOPICS, "more": ("Further tables", [name for name in tables if name not in placed])}
    for page, (title, names) in topics.items():
        known = [name for name in names if name == "" or name in tables]
        if not known:
            continue
        parts = [f"# {title}"]
        for name in known:
            table, many = (schema.root, False) if name == "" else tables[name]
            parts.append(section(schema, checker, name, table, many, 2))
        (out / f"scene_{page}.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")
    for path in out.glob("with_*.toml"):
        path.unlink()
    return [line for path in sorted(out.glob("scene_*.md")) for line in path.read_text(encoding="utf-8").splitlines()
            if re.match(r"\| `\w+` \|", line) and line.split(" | ")[5] == ""]

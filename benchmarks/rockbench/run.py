#!/usr/bin/env python3
"""Runs the engines of RockBench, scores their answers, and writes RESULTS.md. Standard library alone.

    python3 run.py                          every engine, every case: hours of none, minutes of some
    python3 run.py --engine mujoco          one engine; the rows of the others are kept
    python3 run.py --case rock-free         cases whose names begin so; prints, and with --write keeps their rows
    python3 run.py --check my_engine.py     one file anywhere, on every case at its default step; prints, writes nothing;
                                            with --fine it halves the step, too, with --case it takes some cases
    python3 run.py --page                   writes the page again from results.csv
"""

import argparse
import csv
import json
import math
import pathlib
import platform
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

HERE = pathlib.Path(__file__).parent.resolve()
RESULTS = HERE / "results.csv"
COLUMNS = ["engine", "version", "case", "quantity", "setting", "step", "outcome", "value", "answer", "tolerance", "error",
           "cpu_seconds", "simulated", "note"]
# The answer has settled once a halved step changes it by less than this share of its tolerance.
SETTLED = 0.25
# The first step (s), and the number of steps, each half of the one before.
COARSEST = 1 / 240
HALVINGS = 10
# No finer step once a run has taken this long (s of the processor).
ENOUGH = 15.0


# ---------------------------------------------------------------- from a trace to quantities

class Trace:
    """What an engine returned, relative to the ground; see README.md."""

    def __init__(self, case, answer):
        self.case, self.times, self.states = case, answer["times"], answer["states"]
        self.index = {name: i for i, name in enumerate(answer["bodies"])}
        self.forces = answer.get("forces")
        self.planar = case["space"] == "planar"
        if self.planar:
            self.unwrap()
        self.bodies = {b["name"]: b for b in case["bodies"]}
        if not self.times or any(b <= a for a, b in zip(self.times, self.times[1:])):
            raise ValueError("times must grow")
        width = 6 if self.planar else 13
        for row in self.states:
            for state in row:
                if len(state) != width or not all(math.isfinite(v) for v in state):
                    raise ValueError("not finite")

    def unwrap(self):
        """Angles may be returned modulo a turn: no body turns by half of one between two samples."""
        for i in range(len(self.index)):
            before = None
            for row in self.states:
                angle = row[i][2]
                if before is not None and math.isfinite(angle):
                    angle += 2 * math.pi * round((before - angle) / (2 * math.pi))
                    row[i][2] = angle
                before = angle

    def at(self, values, time):
        """Linear between samples."""
        times = self.times
        if time > times[-1] + 1e-6 * max(1.0, time):
            raise ValueError(f"no state at {time} s")
        low, high = 0, len(times) - 1
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if times[middle] <= time else (low, middle)
        a, b = times[low], times[high]
        if b == a or time <= a:
            return values(low)
        share = min(1.0, (time - a) / (b - a))
        return values(low) + share * (values(high) - values(low))

    def coordinate(self, body, axis, wanted=None):
        """Returns a function of the index of a sample."""
        i = self.index[body]
        states = self.states
        if axis in ("dx", "dy", "dz"):
            inner = self.coordinate(body, axis[1:], wanted)
            start = self.initial(body, axis[1:])
            return lambda n: inner(n) - start
        if axis == "lean":
            toward = wanted["toward"]
            return lambda n: math.asin(max(-1.0, min(1.0, sum(
                a * b for a, b in zip(turned(states[n][i][3:7], (0, 0, 1)), toward)))))
        k = ("x", "z", "angle").index(axis) if self.planar else ("x", "y", "z").index(axis)
        return lambda n: states[n][i][k]

    def initial(self, body, axis):
        spec = self.bodies[body]
        if axis == "angle":
            return spec["angle"]
        return spec["position"][("x", "z").index(axis) if self.planar else ("x", "y", "z").index(axis)]

    def window(self, span):
        return [n for n, t in enumerate(self.times) if span[0] - 1e-9 <= t <= span[1] + 1e-9]


def product(p, q):
    a, b, c, d = p
    e, f, g, h = q
    return [a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g,
            a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e]


def turned(q, v):
    size = math.sqrt(sum(c * c for c in q))
    q = [c / size for c in q]
    return product(product(q, [0, *v]), [q[0], -q[1], -q[2], -q[3]])[1:]


def quantity(trace, wanted):
    """Returns the value of a quantity; a list of the meanings is in README.md."""
    kind, body = wanted["kind"], wanted.get("body")
    index = trace.index
    states = trace.states

    def component(offset):
        return lambda n: states[n][index[body]][offset]
    if kind == "position":
        value = trace.at(trace.coordinate(body, wanted["axis"]), wanted["time"])
        if "relative_to" in wanted:
            value -= trace.at(trace.coordinate(wanted["relative_to"], wanted["axis"]), wanted["time"])
        return value
    if kind == "velocity":
        k = 3 + ("x", "z", "angle").index(wanted["axis"]) if trace.planar else 7 + "xyz".index(wanted["axis"])
        return trace.at(component(k), wanted["time"])
    if kind == "spin":
        return trace.at(component(10 + "xyz".index(wanted["axis"])), wanted["time"])
    if kind in ("body_spin", "kinetic_energy", "angular_momentum", "axis", "attitude", "yaw"):
        row = [trace.at(component(k), wanted["time"]) for k in range(6 if trace.planar else 13)]
        q, spin = row[3:7], row[10:13]
        if kind == "axis":
            return turned(q, (0, 0, 1))["xyz".index(wanted["axis"])]
        if kind == "yaw":
            x, y, _ = turned(q, (1, 0, 0))
            return math.atan2(y, x)
        if kind == "attitude":
            size = math.sqrt(sum(c * c for c in q))
            return 2 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(q, wanted["reference"]))) / size))
        own = turned([q[0], -q[1], -q[2], -q[3]], spin)
        spec = trace.bodies[body]
        if kind == "body_spin":
            return own["xyz".index(wanted["axis"])]
        momentum = [i * w for i, w in zip(spec["inertia"], own)]
        if kind == "angular_momentum":
            return turned(q, momentum)["xyz".index(wanted["axis"])]
        return 0.5 * (spec["mass"] * sum(v * v for v in row[7:10]) + sum(l * w for l, w in zip(momentum, own)))
    if kind == "momentum":
        k = 3 + ("x", "z").index(wanted["axis"]) if trace.planar else 7 + "xyz".index(wanted["axis"])
        return sum(trace.bodies[name]["mass"] * trace.at(lambda n, i=i: states[n][i][k], wanted["time"])
                   for name, i in index.items())
    if kind == "distance":
        axes = ("x", "z") if trace.planar else ("x", "y", "z")
        return math.sqrt(sum((trace.at(trace.coordinate(body, a), wanted["time"]) - trace.initial(body, a))**2 for a in axes))
    if kind in ("largest", "peak"):
        of = trace.coordinate(body, wanted["axis"], wanted)
        values = [of(n) for n in trace.window(wanted["between"])]
        return max(map(abs, values)) if kind == "largest" else max(values)
    if kind == "crossing":
        of = trace.coordinate(body, wanted["axis"], wanted)
        side, found = 0, 0
        for n, time in enumerate(trace.times):
            value = of(n) - wanted["level"]
            now = (value > 0) - (value < 0)
            if side and now and now != side:
                found += 1
                if found == wanted["number"]:
                    before = of(n - 1) - wanted["level"]
                    return trace.times[n - 1] + (time - trace.times[n - 1]) * before / (before - value)
            side = now or side
        raise ValueError("it never crosses")
    if kind in ("exceeds", "first_exceeds"):
        names = wanted.get("bodies") or [body]
        ofs = [(trace.coordinate(name, wanted["axis"], wanted), trace.initial(name, wanted["axis"])) for name in names]
        for n, time in enumerate(trace.times):
            if any(abs(of(n) - start) > wanted["level"] for of, start in ofs):
                return True if kind == "exceeds" else time
        if kind == "exceeds":
            return False
        raise ValueError("it never does")
    if kind == "force":
        if trace.forces is None:
            raise Unstated("contact forces")
        pairs = trace.case["forces"]
        values = [trace.forces[n][pairs.index(wanted["pair"])] for n in trace.window(wanted["between"])]
        return sum(values) / len(values)
    raise ValueError(f"no quantity of the kind `{kind}`")


class Unstated(Exception):
    """What an engine cannot state."""


def score(case, answer):
    """Returns a row for every quantity: outcome (`passed`, `failed`, `cannot`), value, error over tolerance, note."""
    cannot = {c["what"]: c["why"] for c in answer.get("cannot", [])}
    rows = []
    trace, fault = None, ""
    if "fault" in answer:
        fault = answer["fault"]
    elif "case" not in cannot:
        try:
            trace = Trace(case, answer)
        except (ValueError, KeyError, TypeError, IndexError) as error:
            fault = str(error) or type(error).__name__
    for wanted in case["quantities"]:
        row = {"case": case["id"], "quantity": wanted["name"], "answer": wanted["answer"], "tolerance": wanted["tolerance"],
               "value": "", "error": "", "note": fault, "outcome": "failed"}
        why = cannot.get("case") or cannot.get(wanted["name"]) or (wanted["kind"] == "force" and cannot.get("forces"))
        if why:
            row.update(outcome="cannot", note=why)
        elif trace:
            try:
                value = quantity(trace, wanted)
                if isinstance(wanted["answer"], bool):
                    error = 0.0 if value == wanted["answer"] else math.inf
                else:
                    error = abs(value - wanted["answer"]) / wanted["tolerance"]
                row.update(value=value, error=error, outcome="passed" if error <= 1 else "failed")
            except Unstated as what:
                row.update(outcome="cannot", note=f"{what}")
            except (ValueError, KeyError, TypeError, IndexError, ZeroDivisionError) as error:
                row.update(note=str(error) or type(error).__name__)
        rows.append(row)
    return rows


# ---------------------------------------------------------------- running

def command(path):
    """The command of an engine: a Python file, a Rust file of Cargo.toml beside this one, or a program."""
    if path.suffix == ".py":
        # The folder of the file stays out of the path of modules, since a file may be named as the package it imports.
        return [sys.executable, "-c", "import runpy, sys; sys.path.pop(0); runpy.run_path(sys.argv[1], run_name='__main__')",
                str(path)]
    if path.suffix == ".rs":
        return [str(HERE / "target" / "release" / path.stem)]
    return [str(path)]


def engines():
    folder = HERE / "engines"
    return {p.stem: p for p in sorted(folder.iterdir()) if p.is_file() and p.name[0] not in "._"}


def build(paths):
    names = [p.stem for p in paths if p.suffix == ".rs"]
    if names:
        bins = [word for name in names for word in ("--bin", name)]
        manifest = str(HERE / "Cargo.toml")
        subprocess.run(["cargo", "build", "--release", "--quiet", "--manifest-path", manifest, *bins], check=True)


def once(path, case, step, limit):
    """Returns what an engine answers."""
    request = {k: v for k, v in case.items() if k != "quantities"}
    if step is not None:
        request["step"] = step
    try:
        # Elsewhere, since some engines write logs where they run.
        done = subprocess.run(command(path), input=json.dumps(request), capture_output=True, text=True, timeout=limit,
                              cwd=tempfile.gettempdir())
    except subprocess.TimeoutExpired:
        return {"fault": f"no answer in {limit:g} s"}
    try:
        # NaN and infinity are words that Python reads and the trace refuses.
        return json.loads(done.stdout)
    except ValueError:
        last = done.stderr.strip().splitlines()[-1:] or ["no answer"]
        return {"fault": last[0]}


def settled(before, after):
    for a, b in zip(before, after):
        if a["outcome"] == "cannot" and b["outcome"] == "cannot":
            continue
        if a["value"] == "" or b["value"] == "":
            if a["value"] != b["value"]:
                return False
        elif isinstance(a["value"], bool):
            if a["value"] != b["value"]:
                return False
        elif abs(a["value"] - b["value"]) > SETTLED * a["tolerance"]:
            return False
    return True


def rows_of(name, case, answer, setting, note=""):
    rows = score(case, answer)
    for row in rows:
        row.update(engine=name, version=answer.get("version", ""), setting=setting, step=answer.get("step", ""),
                   cpu_seconds=answer.get("cpu_seconds", ""), simulated=case["duration"])
        row["note"] = row["note"] or answer.get("fault", "") or note
    return rows


def measure(path, case, fine=True, limit=300.0):
    """Rows at the default step, and at the first step that changes nothing beside one twice as long."""
    name = path.stem
    answer = once(path, case, None, limit)
    rows = rows_of(name, case, answer, "default")
    if not fine or any(c["what"] == "case" for c in answer.get("cannot", [])):
        return rows + [{**row, "setting": "settled"} for row in rows] if fine else rows
    step, before, same = COARSEST, None, 0
    # From the default step on, or from the next of the steps 1/240 s, 1/480 s, … below it; steps below 0.1 ms divide
    # the times of the quantities anyhow.
    default = answer.get("step") or COARSEST
    while step > default * 1.000001 and step > 1e-4:
        step /= 2
    step = default if default <= 1e-4 else step
    # Two wrong verdicts in a row are no convergence: a verdict has to stay for one halving more.
    enough = 2 if any(w["kind"] in ("exceeds", "first_exceeds") for w in case["quantities"]) else 1
    for _ in range(HALVINGS):
        answer = once(path, case, step, limit)
        now = rows_of(name, case, answer, "settled")
        same = same + 1 if before and settled(before, now) else 0
        if same == enough:
            return rows + now
        before = now
        if (answer.get("cpu_seconds") or 0) > ENOUGH:
            break
        step /= 2
    return rows + [{**row, "note": row["note"] or "not settled"} for row in before]


def load_cases(prefix=""):
    files = sorted((HERE / "cases").glob(f"{prefix}*.json"))
    return [json.loads(f.read_text(encoding="utf-8")) for f in files]


def line(outcome, engine, case, quantity, setting, step, value, answer, error, note):
    print(f"{outcome:7} {engine:12} {case:24} {quantity:36} {setting:8} {step:9} {value:>12} {answer:>12} {error:>8}  {note}", flush=True)


def show(rows):
    for r in rows:
        value = f"{r['value']:.6g}" if isinstance(r["value"], float) else str(r["value"])
        answer = f"{r['answer']:.6g}" if isinstance(r["answer"], float) else str(r["answer"])
        error = f"{r['error']:.2f}" if isinstance(r["error"], float) else ""
        step = f"{r['step']:.2e}" if r["step"] else ""
        line(r["outcome"], r["engine"], r["case"], r["quantity"], r["setting"], step, value, answer, error, r["note"])


# ---------------------------------------------------------------- the page

CATEGORIES = {
    "free": "free motion", "slide": "sliding", "roll": "rolling", "impact": "impacts", "rock": "rocking", "stack": "stacks",
    "fall": "falls", "soft": "contacts of a given stiffness", "consensus": "consensus of codes"}
SETTINGS = ("default", "settled")


def read_results():
    if not RESULTS.exists():
        return []
    with RESULTS.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def write_results(rows):
    def short(value):
        return f"{value:.6g}" if isinstance(value, float) else value
    rows = sorted(rows, key=lambda r: (r["engine"], r["case"], r["setting"]))
    with RESULTS.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows({k: short(v) for k, v in row.items()} for row in rows)


def tally(rows):
    counts = {"passed": 0, "failed": 0, "cannot": 0}
    for row in rows:
        counts[row["outcome"]] += 1
    return counts


def engine_order(rows):
    names = sorted({r["engine"] for r in rows})

    def passed(name):
        return sum(r["engine"] == name and r["setting"] == "settled" and r["outcome"] == "passed" for r in rows)
    return sorted(names, key=lambda n: (-passed(n), n))


def cost(rows):
    """Seconds of the processor for a simulated second, the mean over cases that ran."""
    cases = {}
    for row in rows:
        if row["cpu_seconds"]:
            cases[row["case"]] = float(row["cpu_seconds"]), float(row["simulated"])
    simulated = sum(s for _, s in cases.values())
    return sum(c for c, _ in cases.values()) / simulated if simulated else math.nan


def whole_cases(rows):
    """Cost of each case of which every quantity is passed."""
    cases = {}
    for row in rows:
        cases.setdefault(row["case"], []).append(row)
    return {c: float(part[0]["cpu_seconds"] or 0) for c, part in cases.items() if all(r["outcome"] == "passed" for r in part)}


def milliseconds(seconds):
    if math.isnan(seconds):
        return "–"
    return f"{1e3 * seconds:.3g} ms"


def median(values):
    values = sorted(values)
    return values[len(values) // 2] if values else math.nan


def page(rows):
    cases = load_cases()
    covered = {n: len({r["case"] for r in rows if r["engine"] == n and r["setting"] == "settled"} & {c["id"] for c in cases})
               for n in engine_order(rows)}
    names = [n for n in covered if covered[n] == len(cases)]
    count = sum(len(c["quantities"]) for c in cases)
    versions = {r["engine"]: r["version"] for r in rows if r["version"]}

    def of(name, setting, category=None, case=None):
        return [r for r in rows if r["engine"] == name and r["setting"] == setting
                and (category is None or r["case"].split("-")[0] == category) and (case is None or r["case"] == case)]
    text = ["# RockBench: results", "",
            "Made by `python3 run.py` in this folder; do not edit.",
            f"{len(cases)} cases with {count} quantities.",
            "[README.md](README.md) describes the cases, how they are scored, and how to add an engine.",
            "[results.csv](results.csv) has every number on which this page is based.", "",
            "A quantity is passed if its error is at most its tolerance, failed if it is larger or if the run broke, and "
            "“cannot state” if the engine cannot state the case or cannot return the quantity; this is not a failure.",
            "*Default* is an engine as it comes, with its default step if it has one.",
            "*Settled* means that the step is halved, beginning with the default step and with at most 1/240 s, until every quantity of the case changes by less "
            "than a quarter of its tolerance (for a verdict, twice in a row); an adapter may then also choose its engine's most "
            "accurate settings.", "",
            "## Scores", "",
            "| engine | default: passed | failed | cannot state | cost | settled: passed | failed | cannot state | not settled | median step | cost |",
            "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"]
    for name in names:
        line = [f"{name} {versions.get(name, '')}".strip()]
        for setting in SETTINGS:
            part = of(name, setting)
            t = tally(part)
            line += [str(t["passed"]), str(t["failed"]), str(t["cannot"])]
            if setting == "settled":
                line.append(str(len({r["case"] for r in part if r["note"] == "not settled"})))
                steps = {r["case"]: float(r["step"]) for r in part if r["step"] and r["outcome"] != "cannot"}
                line.append(f"{1e3 * median(list(steps.values())):.3g} ms")
            line.append(milliseconds(cost(part)))
        text.append("| " + " | ".join(line) + " |")
    text += ["", "Cost is the processor time for a simulated second, over the cases that an engine ran, on one core of "
             f"a {platform.machine()} machine that other programs used as well. Compare costs only within the table, and only their first digit.",
             "“Not settled” counts cases whose answer still changed at the finest step; they are scored at that step."]
    part = [f"{n} ({c} of {len(cases)} cases)" for n, c in covered.items() if n not in names]
    text += (["Engines that ran only some of the cases are left out of the tables: " + ", ".join(part) + "."] if part else []) + [""]
    for setting, title in (("default", "at the default step"), ("settled", "at the step at which the answer settles")):
        text += [f"## Passed by category, {title}", "",
                 "| category | quantities | " + " | ".join(names) + " |", "|---|---:|" + "---:|" * len(names)]
        for key, words in CATEGORIES.items():
            total = sum(len(c["quantities"]) for c in cases if c["category"] == key)
            cells = []
            for name in names:
                t = tally(of(name, setting, key))
                cells.append(f"{t['passed']}" + (f" ({t['cannot']} cannot)" if t["cannot"] else ""))
            text.append(f"| {words} | {total} | " + " | ".join(cells) + " |")
        text.append("")
    text += ["## Cost by category", "", "Processor time for a simulated second, at the default step → settled.", "",
             "| category | " + " | ".join(names) + " |", "|---|" + "---:|" * len(names)]
    for key, words in CATEGORIES.items():
        cells = [" → ".join(milliseconds(cost(of(name, s, key))) for s in SETTINGS) for name in names]
        text.append(f"| {words} | " + " | ".join(cells) + " |")
    text += ["", "Number of cases of which an engine passes every quantity, and number of these for which no other engine that also "
             "passes every quantity takes less time:", "", "| engine | default: cases | cheapest | settled: cases | cheapest |", "|---|---:|---:|---:|---:|"]
    whole = {(n, s): whole_cases(of(n, s)) for n in names for s in SETTINGS}
    for name in names:
        line = [name]
        for s in SETTINGS:
            best = [c for c, spent in whole[name, s].items() if all(spent <= whole[n, s].get(c, math.inf) for n in names)]
            line += [str(len(whole[name, s])), str(len(best))]
        text.append("| " + " | ".join(line) + " |")
    text.append("")
    notes = HERE / "NOTES.md"
    if notes.exists():
        text += [notes.read_text(encoding="utf-8").strip(), ""]
    text += ["## What an engine cannot state", ""]
    for name in names:
        reasons = {}
        for r in of(name, "default"):
            if r["outcome"] == "cannot":
                reasons.setdefault(r["note"], set()).add(r["case"])
        if reasons:
            text += [f"- **{name}**: " + "; ".join(f"{why} ({len(c)} case{'s' if len(c) > 1 else ''})"
                                                  for why, c in sorted(reasons.items(), key=lambda i: -len(i[1]))) + "."]
        else:
            text += [f"- **{name}**: nothing of these cases."]
    text += ["", "## Every case", "",
             "The largest ratio of error to tolerance among the quantities of a case, at the default step → settled: 1 or less is passed. "
             "∞ is a wrong verdict or a run that broke, – is “cannot state”, * is not settled.", "",
             "| case | quantities | " + " | ".join(names) + " |", "|---|---:|" + "---:|" * len(names)]

    def worst(part):
        part = [r for r in part if r["outcome"] != "cannot"]
        if not part:
            return "–"
        errors = [float(r["error"]) if r["error"] != "" else math.inf for r in part]
        star = "*" if any(r["note"] == "not settled" for r in part) else ""
        e = max(errors)
        short = "∞" if math.isinf(e) else ("<0.01" if e < 0.005 else f"{e:.2f}" if e < 10 else f"{e:.0f}" if e < 1e4 else f"{e:.0e}")
        return (f"**{short}**" if e > 1 else short) + star
    for case in cases:
        cells = [f"{worst(of(n, 'default', case=case['id']))} → {worst(of(n, 'settled', case=case['id']))}" for n in names]
        text.append(f"| `{case['id']}` {case['title']} | {len(case['quantities'])} | " + " | ".join(cells) + " |")
    text += ["", "## Failed at the step at which the answer settles", ""]
    for name in names:
        failed = [r for r in of(name, "settled") if r["outcome"] == "failed"]
        text += [f"### {name}: {len(failed)}", ""]
        if failed:
            text += ["| case | quantity | value | answer | tolerance | note |", "|---|---|---:|---:|---:|---|"]
            text += [f"| `{r['case']}` | {r['quantity']} | {r['value']} | {r['answer']} | {r['tolerance']} | {r['note']} |" for r in failed]
            text.append("")
    (HERE / "RESULTS.md").write_text("\n".join(text).rstrip() + "\n", encoding="utf-8")


# ---------------------------------------------------------------- the command

def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--engine", action="append", help="a file of engines/ by its name; may be repeated")
    parser.add_argument("--case", default="", help="beginning of the names of cases")
    parser.add_argument("--check", metavar="FILE", help="an engine anywhere")
    parser.add_argument("--fine", action="store_true", help="with --check or --case: halve the step, too")
    parser.add_argument("--write", action="store_true", help="with --case: replace the rows of these cases")
    parser.add_argument("--limit", type=float, default=300.0, help="a run that takes longer by the clock (s) is failed")
    parser.add_argument("--jobs", type=int, default=2, help="runs at the same time")
    parser.add_argument("--page", action="store_true", help="writes the page alone")
    words = parser.parse_args()
    if words.page:
        page(read_results())
        return
    known = engines()
    if words.check:
        paths = [pathlib.Path(words.check).resolve()]
    else:
        for name in words.engine or []:
            if name not in known:
                sys.exit(f"no engine `{name}`: {', '.join(known)}")
        paths = [known[n] for n in words.engine or known]
    build(paths)
    cases = load_cases(words.case)
    if not cases:
        sys.exit(f"no case begins with `{words.case}`")
    trial = bool(words.check or words.case and not words.write)
    if trial:
        line("outcome", "engine", "case", "quantity", "setting", "step", "value", "answer", "err/tol", "note")
    for path in paths:
        rows = []
        with ThreadPoolExecutor(words.jobs) as pool:
            for done in pool.map(lambda case: measure(path, case, words.fine or not trial, words.limit), cases):
                rows += done
                if trial:
                    show(done)
        if all(r["outcome"] == "failed" and r["note"] for r in rows):
            print(f"{path.stem} does not run: {rows[0]['note']}", flush=True)
            continue
        for setting in SETTINGS:
            part = [r for r in rows if r["setting"] == setting]
            if part:
                t = tally(part)
                print(f"{path.stem}, {setting}: {t['passed']} passed, {t['failed']} failed, {t['cannot']} cannot state; "
                      f"{milliseconds(cost(part))} of the processor for a simulated second", flush=True)
        if not trial:
            again = {case["id"] for case in cases}
            write_results([r for r in read_results() if r["engine"] != path.stem or r["case"] not in again] + rows)
    if not trial:
        page(read_results())


if __name__ == "__main__":
    main()

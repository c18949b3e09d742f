"""Scenarios from text, files and values."""

from __future__ import annotations

from pathlib import Path

import pytest

import barrelstack
from barrelstack import Scenario, ScenarioError

FOUR = {
    "stack": {"levels": 4, "columns": 2},
    "motion": {"sine": {"amplitude": "10 cm", "period": "0.8 s", "cycles": 5}},
}
TEXT = """
schema = 1
[stack]
levels = 4
columns = 2
[motion.sine]
amplitude = "10 cm"
period = "0.8 s"
cycles = 5
"""


def test_a_dict_is_the_scenario_of_the_same_text() -> None:
    assert Scenario(FOUR) == Scenario(TEXT)
    # Without a text the title describes the source.
    assert Scenario(FOUR).title == "Eight barrels on four levels, sine of 0.80 s"


def test_what_is_written_out_reads_back_to_the_same_run() -> None:
    for name in barrelstack.scenarios():
        scenario = Scenario.load(name)
        assert Scenario(scenario.to_toml()) == scenario, name


def test_setting_makes_a_new_scenario_and_leaves_the_old_one() -> None:
    four = Scenario(FOUR)
    six = four.set("stack.levels", 6)
    assert (four.stack.levels, six.stack.levels) == (4, 6)
    assert six.set("stack.levels", 4) == four
    assert four.set({"stack.levels": 5, "motion.sine.period": "1 s"}).motion.sine.period == "1 s"
    assert Scenario.load("candia-8-barrels", stack__levels=2).stack.levels == 2


def test_scales_replace_one_another_when_they_are_set_in_turn() -> None:
    demo = Scenario.load("demo-napa").set("motion.scale.pgv", "60 cm/s")
    assert demo.set("motion.scale.pga", "0.3 g") == Scenario.load("demo-napa").set("motion.scale.pga", "0.3 g")


def test_fields_are_found_by_completion_with_their_meaning() -> None:
    scenario = Scenario(FOUR)
    assert {"stack", "motion", "run", "interface"} <= set(dir(scenario))
    assert {"levels", "columns", "barrel"} <= set(dir(scenario.stack))
    assert "Kinetic coefficient" in scenario.interface.rack_ground.friction.help("coefficient")
    assert scenario.fields.to_dict()["stack"]["levels"] == 4
    with pytest.raises(AttributeError, match="no field 'levles'"):
        scenario.stack.levles  # noqa: B018


def test_quantities_of_pint_and_of_numpy_are_taken_with_their_unit() -> None:
    pint = pytest.importorskip("pint", reason="no pint")
    numpy = pytest.importorskip("numpy")
    ureg = pint.UnitRegistry()
    values = {
        "stack": {"levels": numpy.int64(4), "columns": 2},
        "motion": {"sine": {"amplitude": 10 * ureg.cm, "period": 800 * ureg.ms, "cycles": numpy.float64(5)}},
    }
    scenario = Scenario(values)
    assert scenario.motion.sine.amplitude == "0.1 m"
    laws = {"stiffness": 2.5 * ureg.kN / ureg.mm, "damping": 3 * ureg.kN * ureg.s / ureg.m}
    stiff = Scenario(FOUR).set({f"interface.rack-ground.{law}": value for law, value in laws.items()})
    assert stiff.interface.rack_ground.stiffness == "2500000 N/m"
    with pytest.raises(TypeError, match="kelvin"):
        Scenario(FOUR).set("motion.sine.period", 3 * ureg.kelvin)


def test_an_error_of_a_file_names_its_line_and_column(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(TEXT.replace("levels", "levles"))
    with pytest.raises(ScenarioError, match="did you mean `levels`") as caught:
        Scenario.load(path)
    assert (caught.value.path, caught.value.line, caught.value.column) == (str(path), 4, 1)
    assert isinstance(caught.value, barrelstack.Error)
    assert isinstance(caught.value, ValueError)


def test_an_error_of_a_value_names_its_path() -> None:
    with pytest.raises(ScenarioError, match="did you mean `levels`") as caught:
        Scenario({"stack": {"levles": 4}})
    assert caught.value.value == "stack.levles=4"
    body = {"name": "b", "mass": "3 N", "shape": {"type": "circle", "radius": "1 m"}, "position": ["0 m", "1 m"]}
    scene = {"kind": "free", "body": [body], "run": {"duration": "1 s"}}
    with pytest.raises(ScenarioError) as caught:
        Scenario(scene)
    assert caught.value.value == 'body.1.mass="3 N"'
    with pytest.raises(TypeError, match="`levels` has the type object"):
        Scenario({"stack": {"levels": object()}})


def test_a_check_says_how_a_stack_comes_to_rest_and_a_run_why_it_does_not() -> None:
    (found,) = Scenario(FOUR).check()
    assert found["barrels"] == 8
    assert found["rest"]["unbalanced"] < 1e-6
    with pytest.raises(barrelstack.RunError) as caught:
        Scenario(TEXT.replace("cycles = 5", "cycles = 5\n[run]\nstep = '5 ms'")).run(variants=0)
    assert "run.step" in str(caught.value)
    assert caught.value.line == 11


def test_the_schema_has_the_fields() -> None:
    schema = Scenario.schema()
    assert "stack" in str(schema["$defs"]["scenario"])


def test_a_scene_has_force_elements() -> None:
    scene = barrelstack.Scene("A weight on a spring", run={"duration": "0.5 s", "settle": False})
    ball = {"type": "circle", "radius": "5 cm"}
    scene.body("ball", shape=ball, mass="20 kg", position=["0 m", "1 m"])
    scene.element("spring", "guide", "ground", "ball", stiffness="8 kN/m", axis="90 deg", at=["0 m", "1 m"])
    (element,) = scene.run().summary["elements"]
    # Released at rest, it presses with twice its weight. Measured: 1e-5.
    assert abs(element["peak_force"]) == pytest.approx(2 * 20 * 9.80665, rel=1e-4)
    scene.element("spring", "rod", "ball", "bell", stiffness="1 kN/m")
    with pytest.raises(barrelstack.ScenarioError, match="two elements are called"):
        scene.run()

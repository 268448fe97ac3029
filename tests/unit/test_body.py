"""A ring from its drawing: mass and inertias of a hollow cylinder."""

from typing import get_args

import numpy as np
import pytest
from command import SCENARIOS
from hypothesis import given, settings
from hypothesis import strategies as st

from sealdyn.scenario.reader import ScenarioError, parse_scenario, with_values
from sealdyn.scenario.templates import template
from sealdyn.scene import scene as scenes
from sealdyn.scene.rings import INERTIAL, MATERIALS, Body, Material
from sealdyn.studies.stability import si_axis

FMR = (SCENARIOS / "fmr_reference.toml").read_text()


BODY = 'body = { inner_diameter = "52 mm", outer_radius = "40 mm", length = "35 mm", material = "silicon carbide" }\n'


def parse(*overrides, text=None):
    return parse_scenario(drawn() if text is None else text, "seal.toml", overrides)


def drawn() -> str:
    """The reference seal with a body for its rotor's mass and inertias."""
    lines = [x for x in FMR.splitlines() if x.split(" ")[0] not in ("mass", "transverse_inertia", "polar_inertia")]
    return "\n".join(lines).replace("[rotor]\n", f"[rotor]\n{BODY}")


def inertias(ring):
    return [getattr(ring, key) for key in INERTIAL]


@pytest.mark.core
@settings(deadline=None)
@given(
    st.floats(0.0, 0.1), st.floats(1e-4, 0.1), st.floats(1e-4, 0.3), st.sampled_from([*MATERIALS]), st.floats(100, 2e4)
)
def test_the_integrals_over_the_ring(inner, width, length, material, density):
    """Against quadrature over radius and length: r dr dz 2 pi rho times 1, r^2, and r^2/2 + z^2."""
    outer = inner + width
    for body in (Body(inner, outer, length, material), Body(inner, outer, length, density=density)):
        rho = MATERIALS[material].density if body.density is None else density

        def over(weight, rho=rho):
            # Exact: the integrands are polynomials of degree 3 and 2.
            nodes, weights = np.polynomial.legendre.leggauss(4)
            r, z = (inner + outer + nodes * width) / 2, nodes * length / 2
            integrand = 2 * np.pi * rho * r[:, None] * weight(r[:, None], z[None, :])
            return weights @ integrand @ weights * width * length / 4

        expected = [over(lambda r, z: 1 + 0 * z), over(lambda r, z: r**2 / 2 + z**2), over(lambda r, z: r**2 + 0 * z)]
        assert body.inertia() == pytest.approx(expected, rel=1e-9)
        assert body.inertia()[2] <= 2 * body.inertia()[1]


def test_a_scene_of_the_drawing_has_its_mass():
    scenario = parse()
    mass = 3100 * 3.141592653589793 * (0.04**2 - 0.026**2) * 0.035
    assert scenario.scene.rotor.mass == pytest.approx(mass, rel=1e-14)
    assert "rotor.body.inner_radius" in scenario.given and scenario.unused() == []
    assert scenario.resolved()["rotor"]["body"]["length"] == 0.035


def test_the_mass_follows_the_body():
    longer = parse("rotor.body.length=70 mm").scene.rotor
    assert longer.mass == pytest.approx(2 * parse().scene.rotor.mass, rel=1e-14)
    assert with_values(parse(), {"rotor.body.length": "70 mm"}).scene.rotor == longer
    assert scenes.with_values(parse().scene, {"rotor.body.length": 0.07}).rotor == longer
    assert with_values(parse(), {"film.clearance": "11 um"}).scene.rotor == parse().scene.rotor
    stator = scenes.counterpart(parse().scene).stator
    assert stator.body == parse().scene.rotor.body and inertias(stator) == inertias(parse().scene.rotor)


def test_a_mass_set_by_a_study_does_without_the_body():
    one = {"rotor.mass": 1.0}
    for rotor in (with_values(parse(), one).scene.rotor, scenes.with_values(parse().scene, one).rotor):
        assert rotor.body is None and inertias(rotor) == [1.0, *inertias(parse().scene.rotor)[1:]]


def test_what_check_prints_is_read_again():
    """Mass and body side by side, if they agree."""
    rotor = parse().scene.rotor
    same = [f"rotor.{key}={value!r}" for key, value in zip(INERTIAL, inertias(rotor), strict=True)]
    assert parse(*same).scene == parse().scene


def test_a_body_of_a_rigid_ring_is_not_used():
    text = drawn().replace("[stator]\n", f"[stator]\n{BODY}")
    assert {key.rpartition(".")[0] for key in parse(text=text).unused()} == {"stator.body"}


@pytest.mark.parametrize(
    "override, key, says",
    [
        ("rotor.mass=1 kg", "rotor.mass", "beside [rotor.body]"),
        ("rotor.polar_inertia=1e-3", "rotor.polar_inertia", "beside [rotor.body]"),
        ("rotor.body.density=3000", "rotor.body.material", "both"),
        ("rotor.body.material=carbon grafite", "rotor.body.material", "nearest 'carbon graphite'"),
        ("rotor.body.outer_radius=20 mm", "rotor.body.outer_radius", "more than inner_radius"),
        ("rotor.body.inner_radius=-1 mm", "rotor.body.inner_radius", ">= 0"),
        ("rotor.body.inner_diameter=-1 mm", "rotor.body.inner_radius", "half of inner_diameter"),
        ("rotor.body.length=0", "rotor.body.length", "> 0"),
        ("rotor.body.lenght=0", "rotor.body.lenght", "nearest 'length'"),
        ("rotor.body={ inner_radius = 0, outer_radius = 1, length = 1 }", "rotor.body.material", "neither"),
    ],
)
def test_refused_in_one_line(override, key, says):
    with pytest.raises(ScenarioError) as caught:
        parse(override)
    assert caught.value.key == key and says in str(caught.value)


def test_a_stability_map_wants_the_mass_itself():
    with pytest.raises(ScenarioError, match="follow from the body"):
        si_axis(parse(), "rotor.body.length=30:40 mm:3", "x")


@pytest.mark.parametrize("key", ["inner_radius", "outer_radius", "length"])
def test_a_body_of_no_world_is_refused_by_its_key(key):
    body = {"inner_radius": "28 mm", "outer_radius": "38 mm", "length": "15 mm", "material": "steel", key: "1e200 m"}
    words = ", ".join(f'{name} = "{value}"' for name, value in body.items())
    with pytest.raises(ScenarioError, match=key):
        parse_scenario(f"{template('fms').split('mass = ')[0]}body = {{ {words} }}\n", "seal")


def test_every_material_has_its_numbers():
    """Names of the key and of the table are the same; each number is that of a solid, in SI units."""
    assert get_args(Material) == tuple(MATERIALS)
    ranges = (1e3, 2e4), (1e10, 1e12), (0.1, 0.4), (1e-6, 3e-5), (5.0, 300.0), (100.0, 1500.0)
    for solid in MATERIALS.values():
        assert all(least < value < most for value, (least, most) in zip(solid, ranges, strict=True))

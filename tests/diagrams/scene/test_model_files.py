"""Models that a scenario brings along: those that ship pass, and each fault is a line that names the file."""

import json

import pytest
import yaml

from canal.errors import InputError
from diagrams.scenario import load_scenario
from diagrams.scene.model_files import check_model
from models import MODELS, SCENARIOS

BOX = "<collision name='c'><geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision>"
INERTIA = "<inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia>"
MASS = f"<inertial><mass>0.1</mass>{INERTIA}</inertial>"


def mesh(uri: str) -> str:
    return f"<collision name='c'><geometry><mesh><uri>{uri}</uri></mesh></geometry></collision>"


def sdf(*links: str, more: str = "") -> str:
    bodies = "".join(f"<link name='l{k}'>{link}</link>" for k, link in enumerate(links))
    return f"<sdf version='1.7'><model name='a'>{more}{bodies}</model></sdf>"


def inertial(mass: str, inertia: str = INERTIA) -> str:
    return f"<inertial><mass>{mass}</mass>{inertia}</inertial>"


def box(size: str) -> str:
    return BOX.replace("0.1 0.1 0.1", size)


@pytest.mark.parametrize("path", sorted(MODELS.glob("[iw]*/*.sdf")), ids=lambda path: path.stem)
def test_what_ships_passes(path):
    check_model(path, [MODELS], carried=path.parent.name == "items")


@pytest.fixture
def folder(tmp_path):
    """A scenario's folder, with meshes that name files elsewhere, and a file beside it."""
    folder = tmp_path / "scenario"
    folder.mkdir()
    (tmp_path / "secret.obj").write_text("v 0 0 0\n")
    (folder / "out.obj").write_text("mtllib a.mtl\nv 0 0 0\n")
    (folder / "a.mtl").write_text("newmtl a\nmap_Kd -s 1 1 ../secret.obj\n")
    (folder / "out.gltf").write_text(json.dumps({"images": [{"uri": "../secret.obj"}]}))
    (folder / "list.gltf").write_text("[]")
    (folder / "link.obj").symlink_to(tmp_path / "secret.obj")
    (folder / "garbage.obj").write_text("garbage\n")
    return folder


def test_a_good_one(folder):
    (folder / "m.sdf").write_text(sdf(MASS + BOX))
    check_model(folder / "m.sdf", [folder], carried=True)
    (folder / "m.urdf").write_text(
        "<robot name='a'><link name='l'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
        "iyz='0'/></inertial><collision><geometry><sphere radius='.1'/></geometry></collision></link></robot>"
    )
    check_model(folder / "m.urdf", [folder], carried=True)


OUTSIDE = ("../secret.obj", "link.obj", "/etc/passwd", "out.obj", "out.gltf")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (sdf(MASS), "no collision shape"),
        (sdf(MASS + BOX.replace("<box><size>0.1 0.1 0.1</size></box>", "<plane/>")), "no collision shape"),
        (sdf(MASS + BOX, MASS + BOX), "2 bodies"),
        (sdf(), "cannot be read"),
        (sdf(MASS + BOX, more="<static>true</static>"), "not static"),
        (sdf(inertial("0") + BOX), "mass '0'"),
        (sdf(inertial("-1") + BOX), "mass '-1'"),
        (sdf(inertial("nan") + BOX), "mass 'nan'"),
        (sdf(inertial("1e9") + BOX), "at most 100"),
        (sdf(inertial("1", INERTIA.replace("1e-4", "0")) + BOX), "moments of inertia 0, 0, 0"),
        (sdf(inertial("1", INERTIA.replace("<ixx>1e-4", "<ixx>1")) + BOX), "two others together"),
        (sdf(MASS + box("-1 0.1 0.1")), "size '-1 0.1 0.1'"),
        (sdf(MASS + box("nan 0.1 0.1")), "size 'nan 0.1 0.1'"),
        (sdf(MASS + box("1e30 0.1 0.1")), "reaches 5e"),
        *((sdf(MASS + mesh(name)), "outside") for name in OUTSIDE),
        (sdf(MASS + mesh("list.gltf")), "glTF"),
        (sdf(MASS + mesh("nowhere.obj")), "does not exist"),
        (sdf(MASS + mesh("garbage.obj")), "."),
        (sdf(MASS + mesh("package://drake_models/x.obj")), "relative"),
        (sdf(MASS + BOX, more="<include><uri>model://x</uri></include>"), "relative"),
        ("", "XML"),
        ("<sdf", "XML"),
        ("<a/>", "cannot be read"),
        ("<!DOCTYPE x [<!ENTITY a 'aaaa'>]><sdf>&a;</sdf>", "entities"),
    ],
)
def test_what_is_wrong_is_said(folder, text, says):
    (folder / "m.sdf").write_text(text)
    with pytest.raises(InputError, match=says) as error:
        check_model(folder / "m.sdf", [folder], carried=True)
    assert "\n" not in str(error.value)


def test_a_fixture_needs_no_mass(folder):
    (folder / "m.sdf").write_text(sdf(BOX))
    check_model(folder / "m.sdf", [folder], carried=False)


@pytest.mark.parametrize(
    ("model", "says"),
    [
        ("m.sdf", r"fixtures\[1\].model: m.sdf has no collision"),
        ("../secret.sdf", r"fixtures\[1\].model: .*outside"),
        ("../secret.obj", r"fixtures\[1\].model: secret.obj is no model"),
        ("x" * 300, "does not exist|too long"),
    ],
)
def test_a_scenario_is_refused_with_the_key(folder, model, says):
    (folder / "m.sdf").write_text(sdf(MASS))
    (folder.parent / "secret.sdf").write_text(sdf(MASS + BOX))
    scenario = yaml.safe_load((SCENARIOS / "relocation.yaml").read_text())
    scenario["fixtures"][1]["model"] = model
    (folder / "s.yaml").write_text(yaml.safe_dump(scenario))
    with pytest.raises(InputError, match=says) as error:
        load_scenario(folder / "s.yaml")
    assert len(str(error.value)) < 400

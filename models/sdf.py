"""Writing SDFormat: the few elements that the models here are made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

Vector = Sequence[float]
Color = tuple[float, float, float]

HEADER = '<?xml version="1.0"?>\n<!-- Written by {script}; change it there. -->\n<sdf version="1.9">\n'


@dataclass(frozen=True)
class Material:
    """What a surface does in contact, as Drake's proximity properties."""

    friction: float
    """Coefficient of friction [-], static and dynamic alike."""
    modulus: float
    """Hydroelastic modulus [Pa]."""
    dissipation: float = 5.0
    """Hunt-Crossley dissipation [s/m]."""
    margin: float = 0.0
    """Speculative margin [m]: contact is foreseen from this far, so that what falls does not sink in within a step."""
    resolution: float = 0.01
    """Edge length of the contact mesh of a curved shape [m]."""

    def sdf(self) -> str:
        """The proximity properties as an SDFormat element."""
        kind = (
            "<drake:compliant_hydroelastic/>"
            f"<drake:hydroelastic_modulus>{self.modulus:g}</drake:hydroelastic_modulus>"
            f"<drake:hydroelastic_margin>{self.margin:g}</drake:hydroelastic_margin>"
        )
        return (
            f"<drake:proximity_properties>{kind}<drake:mesh_resolution_hint>{self.resolution:g}</drake:mesh_resolution_hint>"
            f"<drake:mu_static>{self.friction:g}</drake:mu_static><drake:mu_dynamic>{self.friction:g}</drake:mu_dynamic>"
            f"<drake:hunt_crossley_dissipation>{self.dissipation:g}</drake:hunt_crossley_dissipation>"
            "</drake:proximity_properties>"
        )


def box(size: Vector) -> str:
    """A box with full edge lengths [m]."""
    return f"<box><size>{numbers(size)}</size></box>"


def cylinder(radius: float, length: float) -> str:
    """A cylinder along z."""
    return f"<cylinder><radius>{radius:g}</radius><length>{length:g}</length></cylinder>"


def mesh(uri: str, convex: bool = False) -> str:
    """A mesh file beside the model; convex: its hull is meant."""
    return f"<mesh>{'<drake:declare_convex/>' if convex else ''}<uri>{uri}</uri></mesh>"


def numbers(values: Sequence[float]) -> str:
    """Numbers as SDFormat likes them: at most a micrometre fine, no negative zero."""
    return " ".join(f"{round(v, 6) + 0.0:g}" for v in values)


@dataclass
class Link:
    """One rigid body: collect shapes, then write."""

    name: str
    static: bool = True
    mass: float = 1.0
    inertia: Vector = (1.0, 1.0, 1.0)
    """Principal moments about the link's origin, which is its centre of mass [kg m²]; for links that move."""
    _lines: list[str] = field(default_factory=list)
    _count: int = 0

    def visual(
        self, shape: str, color: Color, position: Vector = (0, 0, 0), rpy: Vector = (0, 0, 0), alpha: float = 1.0
    ) -> None:
        """Add what is seen."""
        self._count += 1
        rgba = numbers((*color, alpha))
        self._lines.append(
            f'<visual name="v{self._count}"><pose>{numbers((*position, *rpy))}</pose><geometry>{shape}</geometry>'
            f"<material><diffuse>{rgba}</diffuse></material></visual>"
        )

    def collision(self, shape: str, material: Material, position: Vector = (0, 0, 0), rpy: Vector = (0, 0, 0)) -> None:
        """Add what is touched."""
        self._count += 1
        self._lines.append(
            f'<collision name="c{self._count}"><pose>{numbers((*position, *rpy))}</pose><geometry>{shape}</geometry>'
            f"{material.sdf()}</collision>"
        )

    def solid(
        self, shape: str, material: Material, color: Color, position: Vector = (0, 0, 0), rpy: Vector = (0, 0, 0)
    ) -> None:
        """Add what is seen and touched alike."""
        self.visual(shape, color, position, rpy)
        self.collision(shape, material, position, rpy)

    def sdf(self) -> str:
        """The link as an SDFormat element."""
        ixx, iyy, izz = self.inertia
        inertial = (
            ""
            if self.static
            else f"    <inertial><mass>{self.mass:g}</mass><inertia><ixx>{ixx:.4g}</ixx><iyy>{iyy:.4g}</iyy>"
            f"<izz>{izz:.4g}</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>\n"
        )
        body = "".join(f"    {line}\n" for line in self._lines)
        return f'  <link name="{self.name}">\n{inertial}{body}  </link>\n'


def write_model(path: Path, name: str, links: Sequence[Link], script: str, extra: str = "") -> None:
    """Write a model of free or welded links; `extra` goes inside the model as it is."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = HEADER.format(script=script) + f' <model name="{name}" xmlns:drake="http://drake.mit.edu">\n'
    text += "".join(link.sdf() for link in links) + extra + " </model>\n</sdf>\n"
    temporary = path.with_suffix(".tmp")
    temporary.write_text(text)
    temporary.replace(path)

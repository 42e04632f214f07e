"""GeoSACS on Drake: what a person runs."""

import importlib.util
import sys
from pathlib import Path


def _take_our_own(names: tuple[str, ...] = ("canal", "diagrams", "models")) -> None:
    """Import the packages that lie beside this one under their names, whatever else has such a name.

    `python -m` looks into the folder it is started from before all others, which may have a `models.py` of its own, and
    there is a `diagrams` on PyPI.

    Raises:
        ImportError: another package of that name is imported already; says which.
    """
    for name in names:
        ours = Path(__file__).resolve().parents[1] / name / "__init__.py"
        if not ours.is_file():  # installed some other way than side by side: the usual search finds them
            continue
        loaded = sys.modules.get(name)
        if loaded is None:
            spec = importlib.util.spec_from_file_location(name, ours, submodule_search_locations=[str(ours.parent)])
            assert spec is not None
            assert spec.loader is not None
            module = importlib.util.module_from_spec(spec)
            sys.modules[name] = module
            spec.loader.exec_module(module)
        elif str(ours.parent) not in map(_resolved, getattr(loaded, "__path__", ())):
            where = getattr(loaded, "__file__", None) or "elsewhere"
            raise ImportError(f"geosacs_drake needs its own '{name}', but {where} was imported before it")


def _resolved(folder: str) -> str:
    return str(Path(folder).resolve())


_take_our_own()

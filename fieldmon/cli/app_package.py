"""Where the app is: in fieldmon as installed, or beside it in its tree."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from fieldmon.errors import SettingError

if TYPE_CHECKING:
    from types import ModuleType

_FIELDMON = Path(__file__).resolve().parents[1]
_INSTALLED = f"{_FIELDMON.name}._app"


def app_package() -> tuple[str, Path]:
    """Return the name of the app's package and its folder; raise `SettingError` without one."""
    for package, folder in ((_INSTALLED, _FIELDMON / "_app"), ("app", _FIELDMON.parent / "app")):
        if (folder / "startup" / "serve.py").is_file():
            return package, folder
    raise SettingError("The app must be installed beside fieldmon, but it was not found.")


def app_words(module: str) -> ModuleType:
    """Return a module of the app's words, which know nothing of pages."""
    import sys
    from importlib import import_module
    from importlib.util import module_from_spec, spec_from_file_location

    _, folder = app_package()
    if _INSTALLED not in sys.modules:
        # by its folder: any folder that one stands in may be named app, too
        spec = spec_from_file_location(
            _INSTALLED, folder / "__init__.py", submodule_search_locations=[str(folder)]
        )
        assert spec is not None  # noqa: S101 - it is a file of Python
        assert spec.loader is not None  # noqa: S101 - as above
        made = module_from_spec(spec)
        sys.modules[_INSTALLED] = made
        spec.loader.exec_module(made)
    return import_module(f"{_INSTALLED}.words.{module}")

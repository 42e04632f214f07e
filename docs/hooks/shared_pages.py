"""Pages that live at the root of the repository, where GitHub looks for them: contributing, changelog, citing."""

import re
from pathlib import Path

import yaml
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).parents[2]


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add them to the site."""
    for name, source in (("contributing", "CONTRIBUTING.md"), ("changelog", "CHANGELOG.md")):
        # Written for a reader in the repository: docs/ is the site's own root.
        text = (ROOT / source).read_text().replace("](docs/", "](../")
        files.append(File.generated(config, f"project/{name}.md", content=text))
    files.append(File.generated(config, "project/citing.md", content=_citing()))
    return files


def _citing() -> str:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    paper = citation["preferred-citation"]
    key = paper["authors"][0]["family-names"].lower() + str(paper["year"])
    authors = " and ".join(f"{a['family-names']}, {a['given-names']}" for a in paper["authors"])
    software = re.sub(r":.*", "", citation["title"])
    return f"""# Citing

The method is the paper's. If this software is of use in your work, cite it:

```bibtex
@inproceedings{{{key}geosacs,
  author    = {{{authors}}},
  title     = {{{paper["title"].replace("GeoSACS", "{GeoSACS}").replace("Canal", "Canal")}}},
  booktitle = {{{paper["collection-title"]}}},
  year      = {{{paper["year"]}}},
}}
```

Where the implementation matters, for example its simulation on Drake or a deviation that it makes from the paper, name
the software and its version as well:

```bibtex
@software{{{software},
  author  = {{{{The {software} authors}}}},
  title   = {{{citation["title"]}}},
  version = {{{citation["version"]}}},
  note    = {{{citation["license"]} licence}},
}}
```

`CITATION.cff` in the repository holds the same in a form that reference managers read.
"""

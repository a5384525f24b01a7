"""Files of CommonRoad in clones of public repositories, read with git: nothing of them becomes part of this project."""

import os
import re
import subprocess
from pathlib import Path

# Repositories with recorded or hand-made scenarios. `fetch` clones those that are missing.
REPOSITORIES = [
    "seungju-k1m/CommonRoad",
    "hans66hsu/commonroad-search",
    "wenqing-2021/commonroad_rl",
    "sunamatya/commonroad_rl",
    "Dixon-Huang/commonroad-geometric",
    "YangSVM/commonroad_planner",
    *(
        f"CommonRoad/{name}"
        for name in [
            "commonroad-automatic-labeling",
            "commonroad-crime",
            "commonroad-drivability-checker",
            "commonroad-io",
            "commonroad-prediction",
            "commonroad-reachable-set",
            "commonroad-rule-simplification",
            "commonroad-scenario-designer",
            "commonroad-scenario-factory",
            "crgeo",
            "environment-model",
            "ltl-augmentation",
            "repair-to-drive",
            "SanDRA",
        ]
    ),
]

# Where cars were recorded, by the name of the file.
SITES = {
    "us101": r"USA_US101",
    "lankershim": r"USA_Lanker",
    "peachtree": r"USA_Peach",
    "mona-east": r"DEU_MONAEast",
    "mona-west": r"DEU_MONAWest",
    "mona-merge": r"DEU_MONAMerge",
    "bendplatz": r"DEU_AachenBendplatz",
    "aah": r"DEU_AAH",
    "highd": r"DEU_Location[A-D]",
}
NGSIM = ["us101", "lankershim", "peachtree"]


def fetch(clones):
    for name in REPOSITORIES:
        folder = Path(clones, name.replace("/", "+"))
        if not folder.exists():
            subprocess.run(["git", "clone", "--quiet", "--depth", "1", f"https://github.com/{name}", str(folder)], check=False)


def git_directory(folder):
    return next((place for place in (folder / ".git", folder / "repo" / ".git", folder / "repo", folder) if (place / "HEAD").exists()), None)


def files(clones):
    """Repository, path, name of the object and size of each XML file, in order."""
    for folder in sorted(Path(clones).glob("*+*")) if os.path.isdir(clones) else []:
        git = git_directory(folder)
        if git is None:
            continue
        listed = subprocess.run(["git", "--git-dir", str(git), "ls-tree", "-r", "-l", "HEAD"], capture_output=True, text=True).stdout
        for line in sorted(listed.splitlines()):
            about, path = line.split("\t", 1)
            size = about.split()[3]
            if path.endswith(".xml") and size.isdigit():
                yield folder.name.replace("+", "/"), path, (git, about.split()[2]), int(size)


def content(place):
    git, name = place
    return subprocess.run(["git", "--git-dir", str(git), "cat-file", "blob", name], capture_output=True).stdout


def site_of(path):
    name = path.rsplit("/", 1)[-1]
    is_scene = re.search(r"_[TS]-\d", name) and "/interactive/" not in path and "/solutions/" not in path
    return next((site for site, pattern in SITES.items() if is_scene and re.match(rf"(C-)?{pattern}", name)), None)

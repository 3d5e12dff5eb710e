"""``python -m benchmarks.explorer`` times the explorers of a built site in headless Chromium.

For each mechanism: the median of a frame in milliseconds, computing and drawing all branches while
the hand moves, and of a map of 300 by 300 postures; on one core, without a GPU.
"""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path

from playwright.sync_api import sync_playwright

FRAMES = """() => {
    const explorer = document.querySelector(".explorer").explorer;
    const { mechanism: m, view } = explorer;
    const [x, q] = [[...explorer.x], [...explorer.q]];
    explorer.times.length = 0;
    for (let k = 0; k < 120; k++) {
        const step = 0.04 * view.radius * Math.sin(k / 10);
        const moved = x.map((v, i) => (m.places.includes(i) ? v + step : v));
        if (m.places.length > 1) explorer.takeTarget(moved);
        else explorer.takeJoints(q.map((v) => v + 0.1 * Math.sin(k / 10)));
        explorer.draw();
    }
    explorer.takeJoints(q);
    return explorer.frameTime();
}"""
MAPS = """() => {
    const { section, x, branch } = document.querySelector(".explorer").explorer;
    if (!section?.measure) return null;
    const times = [];
    for (let k = 0; k < 5; k++) {
        section.start(x, branch, 300, { map: true, workspace: false });
        while (!section.done) section.step(1000);
        times.push(section.milliseconds);
    }
    return times.sort((a, b) => a - b)[2];
}"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("site", nargs="?", type=Path, default=Path("build/site"))
    site = parser.parse_args().site.absolute()
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    print("| mechanism | a frame, ms | a map, ms |\n|---|---:|---:|")
    with sync_playwright() as playwright:
        arguments = ["--no-sandbox", "--disable-gpu"]
        opened = playwright.chromium.launch(executable_path=browser, args=arguments)
        page = opened.new_page(viewport={"width": 1280, "height": 1000})
        for path in sorted((site / "mechanisms").glob("*.html")):
            if path.stem == "index":
                continue
            page.goto(path.as_uri())
            page.wait_for_function("document.querySelector('.explorer')?.explorer?.found")
            frame, taken = page.evaluate(FRAMES), page.evaluate(MAPS)
            shown = "" if taken is None else f"{taken:.0f}"
            print(f"| `{path.stem}` | {frame:.1f} | {shown} |", flush=True)
        opened.close()


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Opens pages in a headless Chromium without a network, at desktop and phone width and on paper, and checks them.

open_pages.py PICTURES PAGE...: pictures go to the folder PICTURES. Exit status 1 if a page has an error, asks for
anything from outside, does not draw a chart, draws fewer settings, levels or points than the table of its figure has rows, has labels
that overlap, a chart that shows one value, or a chart over time without the failures and suspicions that another has, or scrolls
sideways. The SVG pictures beside each page, and those of the settings below it, may not have words that overlap either.
"""

import pathlib
import sys
import tempfile

from playwright.sync_api import BrowserContext, Page, sync_playwright

CHROMIUM = "/usr/bin/chromium"
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
WIDTHS = {"desktop": (1280, 900), "phone": (390, 844)}

# Of each chart: its name, how many traces it is given, and how many it has drawn.
CHARTS = """() => [...document.querySelectorAll('.plotly-graph-div')].map(div => ({
    id: div.id,
    given: (div.data || []).length,
    drawn: (div.calcdata || []).length,
    marks: div.querySelectorAll('.plot path, .plot .point').length,
    width: div.getBoundingClientRect().width,
}))"""
# Of each chart of a figure: how many things its table says that there are, how many are drawn inside its axes, and which labels overlap.
DRAWN = """() => [...document.querySelectorAll('figure')].flatMap(figure => {
    const head = [...figure.querySelectorAll('thead th')].map(cell => cell.textContent);
    const rows = [...figure.querySelectorAll('tbody tr')].map(row => [...row.children].map(cell => cell.textContent));
    const inside = (box, area) => box.left > area.left - 2 && box.right < area.right + 2 && box.top > area.top - 2 && box.bottom < area.bottom + 2;
    const shown = mark => { const box = mark.getBoundingClientRect(); return box.width > 0 && box.height > 0; };
    return [...figure.querySelectorAll('.plotly-graph-div')].map(div => {
        const area = div.querySelector('.nsewdrag').getBoundingClientRect();
        const count = selector => [...div.querySelectorAll(selector)]
            .filter(mark => shown(mark) && inside(mark.getBoundingClientRect(), area)).length;
        const labels = [...div.querySelectorAll('.xtick text, .ytick text, .y2tick text, .xtitle, .ytitle, .textpoint text, .legendtext')].filter(shown);
        const boxes = labels.map(label => [label.textContent, label.getBoundingClientRect()]);
        // Corners on the screen, as far as letters reach: names along an axis may be turned.
        const corners = label => {
            const box = label.getBBox(), matrix = label.getScreenCTM(), inset = 2;
            const [left, right, top, bottom] = [box.x + inset, box.x + box.width - inset, box.y + inset, box.y + box.height - inset];
            return [[left, top], [right, top], [right, bottom], [left, bottom]]
                .map(([x, y]) => [matrix.a * x + matrix.c * y + matrix.e, matrix.b * x + matrix.d * y + matrix.f]);
        };
        const shapes = labels.map(corners);
        // Two rectangles are apart if they are along a side of one of them.
        const apart = (a, b) => [a, b].some(shape => [0, 1].some(side => {
            const along = [shape[side + 1][0] - shape[side][0], shape[side + 1][1] - shape[side][1]];
            const reach = other => other.map(([x, y]) => x * along[0] + y * along[1]);
            const [one, two] = [reach(a), reach(b)];
            return Math.max(...one) <= Math.min(...two) || Math.max(...two) <= Math.min(...one);
        }));
        const overlaps = boxes.flatMap(([name], place) => boxes.slice(place + 1).map(([other], after) => [other, place + 1 + after])
            .filter(([_, other]) => !apart(shapes[place], shapes[other]))
            .map(([other]) => name + ' | ' + other));
        const outside = boxes.filter(([_, box]) => box.left < -1 || box.right > document.documentElement.clientWidth + 1).map(([name]) => name);
        return {
            id: div.id, head, rows, overlaps, outside,
            height: div.getBoundingClientRect().height,
            points: count('.scatterlayer .point'), texts: count('.scatterlayer .textpoint text'),
            lines: [...div.querySelectorAll('.scatterlayer .js-line')].filter(line => parseFloat(getComputedStyle(line).strokeWidth) > 0).length,
            ticks: [div.querySelectorAll('.xtick text').length, div.querySelectorAll('.ytick text').length],
            cells: div.data.filter(trace => trace.type === 'heatmap').map(trace => [trace.z.length, trace.z[0].length])[0] || [0, 0],
            first: div.data.length ? div.data[0].type : '',
        };
    });
})"""
# Of each chart: the range of all numbers that it draws along its axis of values, whether it is over time, and its rows of marks.
VALUES = """() => [...document.querySelectorAll('.plotly-graph-div')].map(div => {
    const numbers = list => [...(list || [])].flat().filter(value => typeof value === 'number' && isFinite(value));
    const marks = div.data.filter(trace => trace.yaxis === 'y2');
    // Along whichever axis is of numbers; of a box its ends, of a map of colours its colours.
    const values = div.data.filter(trace => trace.yaxis !== 'y2').flatMap(trace => {
        if (trace.type === 'heatmap') return numbers(trace.z);
        if (trace.type === 'box') return [...numbers(trace.lowerfence), ...numbers(trace.upperfence)];
        if (trace.orientation === 'h') return numbers(trace.x);
        const [x, y] = [numbers(trace.x), numbers(trace.y)];
        const up = [...numbers(trace.error_x && trace.error_x.array), ...numbers(trace.error_x && trace.error_x.arrayminus)];
        return y.length ? y : [...x, ...up.flatMap(length => [x[0] + length])];
    });
    const title = axis => (axis && axis.title && (axis.title.text || axis.title)) || '';
    const across = title(div.layout.xaxis);
    const shown = mark => { const box = mark.getBoundingClientRect(); return box.width + box.height > 0; };
    return {
        id: div.id, flat: values.length > 0 && Math.max(...values) === Math.min(...values), values: values.length,
        over_time: across === 'time, s' || across === 'control steps' && div.id.startsWith('completion-0'),
        marks: marks.filter(trace => trace.mode === 'markers').reduce((sum, trace) => sum + trace.x.length, 0),
        worded: marks.filter(trace => trace.mode === 'markers').every(trace => trace.hovertext.every(words => words.length > 4)),
        drawn: [...div.querySelectorAll('.subplot.xy2 .scatterlayer .point, .xy2 .scatterlayer .point')].filter(shown).length,
    };
})"""
# Of a picture, which words overlap; what is written twice, for its halo, counts once.
WORDS = """() => {
    const words = [...document.querySelectorAll('svg text')].filter(text => !text.getAttribute('stroke'));
    const boxes = words.map(text => [text.textContent, text.getBoundingClientRect()]);
    return boxes.flatMap(([name, a], place) => boxes.slice(place + 1)
        .filter(([_, b]) => a.left < b.right - 0.5 && b.left < a.right - 0.5 && a.top < b.bottom - 2 && b.top < a.bottom - 2)
        .map(([other]) => name + ' | ' + other));
}"""
SETTINGS = "() => document.querySelectorAll('#found table tbody tr').length"
OVERFLOW = "() => document.documentElement.scrollWidth - document.documentElement.clientWidth"


def faults(page: Page) -> list[str]:
    """What is wrong with the charts and the layout of an open page."""
    found = []
    charts = page.evaluate(CHARTS)
    expected = page.content().count("Plotly.newPlot(\"")
    if not charts or len(charts) != expected:
        found.append(f"{len(charts)} charts on the page, {expected} in its source")
    for chart in charts:
        if chart["given"] == 0 or chart["drawn"] != chart["given"] or chart["marks"] == 0 or chart["width"] < 100:
            found.append(f"chart not drawn: {chart}")
    overflow = page.evaluate(OVERFLOW)
    if overflow > 0:
        found.append(f"the page is {overflow} px wider than its window")
    return found


def counted(page: Page) -> list[str]:
    """What is wrong with what charts draw, held against the rows of their tables, and with their labels."""
    found = []
    settings = page.evaluate(SETTINGS)
    for chart in page.evaluate(DRAWN):
        name, rows = chart["id"], chart["rows"]
        found += [f"{name}: labels overlap: {pair}" for pair in chart["overlaps"][:3]]
        found += [f"{name}: a label leaves the page: {label}" for label in chart["outside"][:3]]
        if chart["height"] > 1500:
            found.append(f"{name}: {chart['height']} px high")
        first = {tuple(row[:1]) for row in rows}
        if name.startswith("by-setting-"):
            # A setting without a value has its row all the same, and no mark.
            valued = sum(row[2] != "–" for row in rows)
            expected = {"points": valued, "ticks": settings, "rows": settings}
        elif name.startswith("pareto-"):
            expected = {"points": len(rows)}
        elif name.startswith("completion-by-setting-"):
            expected = {"lines": len(first)}
        elif name.startswith("effects-"):
            expected = {"points": len(rows), "ticks": len(rows)}
        elif name.startswith("levels-") and chart["first"] == "scatter":
            expected = {"points": len(rows), "lines": len({row[1] for row in rows})}
        elif name.startswith("levels-"):
            expected = {"cells": len(rows)}
        elif name.startswith("differences-") and chart["first"] == "heatmap":
            expected = {"cells": settings**2, "ticks": settings}
        elif name.startswith("differences-"):
            expected = {"points": len(rows), "ticks": len(rows)}
        else:
            continue
        drawn = {
            "points": chart["points"],
            "lines": chart["lines"],
            "ticks": chart["ticks"][1],
            "cells": chart["cells"][0] * chart["cells"][1],
            "rows": len(rows),
        }
        found += [f"{name}: {drawn[what]} {what} and not {count}" for what, count in expected.items() if drawn[what] != count]
    return found


def told(page: Page) -> list[str]:
    """Charts that say nothing, and charts over time that leave out what happened."""
    found = []
    charts = page.evaluate(VALUES)
    for chart in charts:
        # A map of robots shows places, of whatever value.
        if chart["flat"] and not chart["id"].startswith("map-"):
            found.append(f"{chart['id']}: a chart of one value")
        if chart["marks"] and not chart["worded"]:
            found.append(f"{chart['id']}: marks without words")
        if chart["drawn"] < chart["marks"]:
            found.append(f"{chart['id']}: {chart['drawn']} of {chart['marks']} marks drawn")
    over_time = [chart for chart in charts if chart["over_time"]]
    marked = [chart for chart in over_time if chart["marks"]]
    if marked and len(marked) < len(over_time):
        found.append(f"not marked: {[chart['id'] for chart in over_time if not chart['marks']]}")
    if page.locator("#suspicions").count() and not marked:
        found.append("suspicions, and no chart over time has a mark")
    return found


def pictures_of(context: BrowserContext, folder: pathlib.Path) -> list[str]:
    """What is wrong with the pictures in a folder and in the folders of settings."""
    found = []
    page = context.new_page()
    for file in sorted([*folder.glob("*.svg"), *folder.glob("*/*.svg")]):
        page.set_content(file.read_text(encoding="utf-8"))
        found += [f"{file.parent.name}/{file.name}: words overlap: {pair}" for pair in page.evaluate(WORDS)[:3]]
    page.close()
    return found


def hover(page: Page) -> list[str]:
    """A chart of rows must answer to the pointer: the headers of a scenario's page, a figure by setting of a study's."""
    chart = page.locator("#headers-0, [id^=by-setting].plotly-graph-div").first
    area = chart.locator(".nsewdrag").first
    area.scroll_into_view_if_needed()
    box = area.bounding_box()
    rows = chart.evaluate("chart => chart.data[0].y.length")
    # The middle of the first row, from left to right.
    steps = 60
    for step in range(1, steps):
        page.mouse.move(box["x"] + box["width"] * step / steps, box["y"] + box["height"] / rows / 2)
        page.wait_for_timeout(40)
        if chart.locator(".hoverlayer .hovertext").count() > 0:
            return []
    return ["a chart did not answer to the pointer"]


def open_page(context: BrowserContext, path: pathlib.Path, pictures: pathlib.Path, device: str) -> list[str]:
    found: list[str] = []
    page = context.new_page()
    page.on("console", lambda message: message.type in ("error", "warning") and found.append(f"console: {message.text}"))
    page.on("pageerror", lambda error: found.append(f"error: {error}"))
    own = path.resolve().as_uri()
    page.on("request", lambda r: r.url.split("#")[0] != own and not r.url.startswith(("data:", "blob:")) and found.append(f"request: {r.url}"))
    page.goto(own)
    page.wait_for_timeout(500)
    found += faults(page)
    found += counted(page)
    found += told(page)
    name = f"{path.parent.name}-{device}"
    page.screenshot(path=pictures / f"{name}.png", full_page=True)
    if device == "desktop":
        page.pdf(path=pictures / f"{name}.pdf", prefer_css_page_size=True)
        found += hover(page)
    page.close()
    return [f"{name}: {fault}" for fault in found]


def main() -> int:
    pictures = pathlib.Path(sys.argv[1])
    pages = [pathlib.Path(page) for page in sys.argv[2:]]
    pictures.mkdir(parents=True, exist_ok=True)
    found = []
    with sync_playwright() as playwright:
        for device, (width, height) in WIDTHS.items():
            with tempfile.TemporaryDirectory() as profile:
                context = playwright.chromium.launch_persistent_context(
                    profile,
                    executable_path=CHROMIUM,
                    headless=True,
                    args=FLAGS,
                    viewport={"width": width, "height": height},
                    has_touch=device == "phone",
                    is_mobile=device == "phone",
                    offline=True,
                )
                for page in pages:
                    found += open_page(context, page, pictures, device)
                    if device == "desktop":
                        found += pictures_of(context, page.parent)
                context.close()
    for fault in found:
        print(fault, file=sys.stderr)
    print(f"{len(pages)} pages at {len(WIDTHS)} widths: {len(found)} faults; pictures in {pictures}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())

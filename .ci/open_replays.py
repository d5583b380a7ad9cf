#!/usr/bin/env python3
"""Opens replays in a headless Chromium without a network, at desktop and phone width, and drives all that they offer.

open_replays.py PICTURES REPLAY...: pictures go to the folder PICTURES. Exit status 1 if a replay has an error, asks for anything
from outside, shows positions that are not those of its data, does not do what a control says, or scrolls sideways.
"""

import base64
import gzip
import json
import pathlib
import re
import struct
import sys

from playwright.sync_api import BrowserContext, Page, sync_playwright
from playwright.sync_api import TimeoutError as Overdue

CHROMIUM = "/usr/bin/chromium"
FLAGS = ["--no-sandbox"]
WIDTHS = {"desktop": (1280, 900), "phone": (390, 844)}
OVERFLOW = "() => document.documentElement.scrollWidth - document.documentElement.clientWidth"
# Controls that are cut by the window or lie over each other.
CROWDED = """() => {
    const shown = [...document.querySelectorAll('button, #controls label, #controls output, h1, h2, #side label, figcaption, #marks > span')]
        .filter(element => element.getClientRects().length && !element.closest('dialog') && !element.closest('#robot'));
    const boxes = shown.map(element => [element.id || element.textContent.slice(0, 30), element.getBoundingClientRect(), element]);
    const cut = boxes.filter(([, box]) => box.left < -1 || box.right > document.documentElement.clientWidth + 1).map(([name]) => name + ' is cut');
    const over = boxes.flatMap(([name, a, one], i) => boxes.slice(i + 1)
        .filter(([, b, other]) => !one.contains(other) && !other.contains(one)
            && a.left < b.right - 1.5 && b.left < a.right - 1.5 && a.top < b.bottom - 1.5 && b.top < a.bottom - 1.5)
        .map(([other]) => name + ' lies over ' + other));
    return [...cut, ...over];
}"""


class Data:
    """The columns of a replay, read without its script."""

    def __init__(self, path: pathlib.Path):
        page = path.read_text(encoding="utf-8")
        self.meta = json.loads(re.search(r'<script id="meta"[^>]*>(.*?)</script>', page, re.S).group(1))
        self.bytes = gzip.decompress(base64.b64decode(re.search(r'<script id="data"[^>]*>(.*?)</script>', page, re.S).group(1)))

    def column(self, name: str, kind: str) -> list:
        offset, length = self.meta["sections"].get(name, [0, 0])
        return list(struct.unpack_from(f"<{length // struct.calcsize(kind)}{kind}", self.bytes, offset))

    def positions(self, frame: int) -> list[float]:
        """Where the robots are at a frame, in metres, as x and y in turn."""
        meta = self.meta
        steps = meta["frames"]["count"] - 1
        kind = "h" if meta["frames"]["width"] == 2 else "i"
        axes = []
        for axis in "xy":
            first = self.column(axis + "0", "i")
            differences = self.column("d" + axis, kind)
            axes.append([first[r] + sum(differences[r * steps:r * steps + frame]) for r in range(meta["robots"])])
        return [value * meta["frames"]["quantum_m"] for pair in zip(*axes) for value in pair]

    def links(self, frame: int) -> int | None:
        """How many links there are at a frame. None if the page must find them and the pairs are too many to try here."""
        meta = self.meta
        if meta["range_m"] is None:
            if meta["links"] is None:
                return 0
            sample = min(frame // meta["links"]["every_frames"], meta["links"]["samples"] - 1)
            until = self.column("toggle_first", "I")[sample + 1]
            held: set[tuple[int, int]] = set()
            for pair in list(zip(self.column("toggle_a", "I"), self.column("toggle_b", "I")))[:until]:
                held ^= {pair}
            return len(held)
        if meta["robots"] > 1000:
            return None
        quantum = meta["frames"]["quantum_m"]
        at = [round(value / quantum) for value in self.positions(frame)]
        places = list(zip(at[::2], at[1::2]))
        reach = (meta["range_m"] / quantum) ** 2
        return sum((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 <= reach for i, a in enumerate(places) for b in places[:i])

    def roles(self, t: float) -> dict[str, int]:
        last = dict.fromkeys(range(self.meta["robots"]), 0)
        for at, robot, role in zip(self.column("role_t", "f"), self.column("role_robot", "I"), self.column("role", "B")):
            if at <= t + 1e-5:
                last[robot] = role
        return {name: sum(role == i for role in last.values()) for i, name in enumerate(self.meta["roles"])}


class Driver:
    """An open page, and what was found wrong with it."""

    def __init__(self, page: Page, data: Data, found: list[str]):
        self.page, self.data, self.meta, self.found = page, data, data.meta, found

    def expect(self, holds: bool, words: str) -> None:
        if not holds:
            self.found.append(words)

    def get(self, call: str):
        return self.page.evaluate(f"() => desimReplay.{call}")

    def settle(self) -> None:
        """Waits until what was asked for is drawn and written."""
        self.page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))))")

    def until(self, condition: str, words: str) -> None:
        """Waits for what the page does in its own time, longer than any machine should need."""
        try:
            self.page.wait_for_function(condition, timeout=10_000)
        except Overdue:
            self.found.append(words)

    def key(self, key: str) -> None:
        self.page.keyboard.press(key)
        self.settle()

    def seek(self, t: float) -> None:
        self.page.evaluate("t => desimReplay.seek(t)", t)
        self.settle()

    def frame_time(self, frame: int) -> float:
        return min(frame * self.meta["frames"]["every_s"], self.meta["duration_s"])

    def close(self, value: float, wanted: float, words: str, by: float = 1e-6) -> None:
        self.expect(abs(value - wanted) <= by, f"{words}: {value}, not {wanted}")

    def data_shown(self) -> None:
        """Positions, links and roles are those of the data, wherever the page comes from."""
        last = self.meta["frames"]["count"] - 1
        for frame in (0, last, last // 2, last // 2 + 1, last // 3, 1):
            shown = list(self.page.evaluate("t => [...desimReplay.positions(t)]", self.frame_time(frame)))
            wanted = self.data.positions(frame)
            self.expect(max(map(lambda pair: abs(pair[0] - pair[1]), zip(shown, wanted)), default=0) < 1e-9, f"positions of frame {frame}")
        if last > 1:
            a, b, between = (list(self.page.evaluate("t => [...desimReplay.positions(t)]", t))
                             for t in (self.frame_time(0), self.frame_time(1), self.frame_time(1) / 4))
            self.expect(all(abs(m - (p + (q - p) / 4)) < 1e-9 for p, q, m in zip(a, b, between)), "positions between frames")
        for frame in (last // 2, last // 4, last, 0):
            self.seek(self.frame_time(frame))
            links = self.data.links(frame)
            if links is not None:
                self.expect(self.get("links()") == links, f"links of frame {frame}: {self.get('links()')}, not {links}")
            self.expect(self.get("roleCounts()") == self.data.roles(self.frame_time(frame)), f"roles of frame {frame}")

    def keys(self) -> None:
        every = self.meta["frames"]["every_s"]
        self.page.evaluate("() => document.activeElement.blur()")
        self.key("Home")
        self.close(self.get("time()"), 0, "Home")
        self.key("ArrowRight")
        self.close(self.get("time()"), every, "one frame on")
        self.key("Shift+ArrowRight")
        self.close(self.get("time()"), 11 * every, "ten frames on")
        self.key("ArrowLeft")
        self.close(self.get("time()"), 10 * every, "one frame back")
        self.key("End")
        self.close(self.get("time()"), self.meta["duration_s"], "End")
        self.key("Home")
        self.key(" ")
        self.expect(self.get("playing()"), "space does not play")
        self.page.wait_for_timeout(300)
        self.key(" ")
        self.expect(not self.get("playing()") and self.get("time()") > 0, "space does not pause, or the time does not pass")
        speed = self.page.inner_text("#speed")
        self.key(".")
        self.expect(self.page.inner_text("#speed") != speed, "faster")
        self.key(",")
        self.expect(self.page.inner_text("#speed") == speed, "slower")
        if self.page.is_visible("#show-links"):
            self.key("l")
            self.expect(self.get("links()") == 0, "links are not switched off")
            self.key("l")
        for follows in (True, False):
            self.key("f")
            self.expect((self.page.input_value("#robot-number") != "") == follows, f"f: following should be {follows}")
        for key, open_ in (("?", True), ("Escape", False)):
            self.key(key)
            self.expect(self.page.is_visible("#help") == open_, f"help after {key}")

    def controls(self) -> None:
        page = self.page
        self.seek(0)
        for _ in range(2):
            page.click("#play")
            page.wait_for_timeout(200)
        self.expect(self.get("time()") > 0 and not self.get("playing()"), "the play button")
        for button, t in (("#end", self.meta["duration_s"]), ("#home", 0), ("#on", self.frame_time(1)), ("#back", 0)):
            page.click(button)
            self.close(self.get("time()"), t, button)
        for selector in ("#scrub", "#strip"):
            page.locator(selector).scroll_into_view_if_needed()
            box = page.locator(selector).bounding_box()
            page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
            self.settle()
            self.close(self.get("time()"), self.meta["duration_s"] / 2, selector, self.meta["duration_s"] * 0.02)
        if self.meta["series"]:
            page.locator(".plot canvas").first.scroll_into_view_if_needed()
            box = page.locator(".plot canvas").first.bounding_box()
            page.mouse.click(box["x"] + box["width"] * 0.8, box["y"] + 40)
            self.settle()
            self.expect(self.get("time()") > self.meta["duration_s"] * 0.6, "a click on a chart does not jump")
        page.locator("#picture").scroll_into_view_if_needed()
        with page.expect_download() as download:
            page.click("#picture")
        self.expect(pathlib.Path(download.value.path()).read_bytes()[:4] == b"\x89PNG", "the saved picture is no PNG")
        role = page.locator("#roles input").first
        role.uncheck()
        self.expect(not page.evaluate("roles.shown[0]"), "a role stays when it is switched off")
        role.check()

    def messages(self) -> None:
        page, copies = self.page, self.meta["messages"]["copies"]
        if not self.meta["messages"]["count"]:
            return
        # When a message, or a copy of one, in the middle of the list has just come.
        self.seek(page.evaluate("copies => copies ? columns.copy_t[copies >> 1] : columns.msg_t[meta.messages.count >> 1]", copies))
        self.expect(page.inner_text("#caption").startswith("Last 0.3 s: "), "nothing is said of the messages")
        self.expect(page.evaluate("copies => (copies ? near.lines : near.rings) > 0", copies), "no messages are drawn")
        page.locator("#topics input").first.uncheck()
        self.settle()
        self.expect(page.evaluate("near.ringHead.slice(0, AGES).every(head => head < 0)"), "a topic stays when it is switched off")
        page.locator("#topics input").first.check()
        page.evaluate("() => document.activeElement.blur()")
        self.key("m")
        self.expect("not drawn" in page.inner_text("#caption"), "messages are not switched off")
        self.key("m")
        self.key(".")
        page.evaluate("() => desimReplay.play()")
        page.wait_for_timeout(500)
        self.expect(not copies or "slower" in page.inner_text("#caption"), "nothing is said of the lines left out at a higher speed")
        page.evaluate("() => desimReplay.pause()")
        self.key(",")

    def pinch(self) -> None:
        """Two fingers that part make the picture larger."""
        page = self.page
        page.locator("#scene").scroll_into_view_if_needed()
        box = page.locator("#scene").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        before = page.evaluate("view.scale")
        session = page.context.new_cdp_session(page)
        for kind, apart in (("touchStart", 30), ("touchMove", 50), ("touchMove", 80), ("touchEnd", None)):
            points = [] if apart is None else [{"x": x - apart, "y": y, "id": 0}, {"x": x + apart, "y": y, "id": 1}]
            session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
            self.settle()
        self.expect(page.evaluate("view.scale") > before * 1.5, "a pinch does not zoom")
        page.click("#fit")
        self.expect(page.evaluate("view.fitted"), "the fit button")

    def video(self) -> None:
        self.seek(0)
        self.page.click("#video")
        self.page.wait_for_timeout(1500)
        with self.page.expect_download() as download:
            self.page.click("#video")
        self.expect(pathlib.Path(download.value.path()).stat().st_size > 1000, "the video is empty")
        self.page.evaluate("() => desimReplay.pause()")

    def following(self, touch: bool) -> None:
        page = self.page
        # In the middle of the run: the first robot that the picture shows alone is found under the pointer.
        self.seek(self.frame_time(self.meta["frames"]["count"] // 2))
        page.locator("#scene").scroll_into_view_if_needed()
        box = page.locator("#scene").bounding_box()
        robot = self.meta["robots"] // 2
        x, y = page.evaluate("robot => [screenX[robot], screenY[robot]]", robot)
        (page.touchscreen.tap if touch else page.mouse.click)(box["x"] + x, box["y"] + y)
        self.settle()
        chosen = page.input_value("#robot-number")
        self.expect(chosen != "", "a click on a robot follows nobody")
        self.expect(page.locator("#robot dl").count() == 1, "nothing is said of the followed robot")
        page.fill("#robot-number", "1")
        page.press("#robot-number", "Enter")
        page.wait_for_timeout(800)
        self.expect("robot=1" in page.evaluate("location.hash"), "the address does not name the followed robot")
        if not touch:
            before = page.evaluate("view.scale")
            page.mouse.move(box["x"] + x, box["y"] + y)
            page.mouse.wheel(0, -300)
            self.settle()
            self.expect(page.evaluate("view.scale") > before, "the wheel does not zoom")
            at = page.evaluate("[view.x, view.y]")
            page.mouse.down()
            page.mouse.move(box["x"] + x + 40, box["y"] + y + 30, steps=4)
            page.mouse.up()
            self.settle()
            self.expect(page.evaluate("[view.x, view.y]") != at, "dragging does not pan")
            page.mouse.dblclick(box["x"] + 5, box["y"] + 60)
            self.settle()
            self.expect(page.evaluate("view.fitted"), "a double click does not fit")

    def fragment(self) -> None:
        t = round(self.meta["duration_s"] / 3, 2)
        # The page is busy, and about to write an address of its own when it is given this one.
        self.page.wait_for_timeout(600)
        self.page.evaluate("""t => {
            desimReplay.seek(t / 2);
            setTimeout(() => { location.hash = `#t=${t}&robot=2`; }, 100);
            for (const start = performance.now(); performance.now() < start + 800;) ;
        }""", t)
        self.until("document.querySelector('#robot-number').value === '2'", "the robot of the address")
        self.close(self.get("time()"), t, "the time of the address", 1e-3)
        self.seek(1)
        self.until("location.hash === '#t=1&robot=2'", "the address does not keep up")

    def events(self) -> None:
        page = self.page
        if not self.meta["events"]:
            self.expect(not page.is_visible("#happenings"), "a list without events")
            return
        self.seek(self.meta["duration_s"] / 2)
        rows = page.locator(".event:visible")
        self.expect(0 < rows.count() < 60, f"{rows.count()} rows for {len(self.meta['events'])} events")
        rows.nth(min(4, rows.count() - 1)).click()
        self.settle()
        event = self.get("selectedEvent()")
        self.expect(event is not None, "a click chooses no event")
        if event:
            self.close(self.get("time()"), event["t"], "a click on an event does not jump")
            for line in event.get("detail") or []:
                self.expect(line in page.inner_text("#detail"), f"the detail {line} is missing")
            if any(line.startswith("desim ") for line in event.get("detail") or []):
                page.click("#detail button")
                page.wait_for_timeout(100)
                self.expect(page.inner_text("#detail button") == "Copied", "the command is not copied")
        page.focus("#events")
        page.keyboard.press("ArrowDown")
        self.settle()
        others = len(self.meta["events"]) > 1
        self.expect(not others or self.get("selectedEvent()") != event, "arrow down chooses no other event")
        kind = page.locator("#kinds input").first
        kind.uncheck()
        self.expect(" of " in page.inner_text("#events-title"), "the filter by kind")
        kind.check()
        only = page.locator("#kinds label", has_text="followed robot only").locator("input")
        if only.is_visible():
            only.check()
            self.expect(" of " in page.inner_text("#events-title"), "the filter by followed robot")
            only.uncheck()

    def reliance(self) -> None:
        """Whom a robot relies on, at a time in the middle of the run, and what its changes of role say."""
        page, middle = self.page, self.meta["duration_s"] * 0.8
        last = {}
        for t, robot, others in self.meta["relies"]:
            if t <= middle:
                last[robot] = others
        robot, others = next(((robot, others) for robot, others in last.items() if others), (None, []))
        if robot is None:
            return
        self.seek(middle)
        page.fill("#robot-number", str(robot))
        page.press("#robot-number", "Enter")
        self.settle()
        wanted = ", ".join(map(str, others))
        self.expect(wanted in page.inner_text("#robot"), f"robot {robot} relies on {wanted}, and the page does not say so")
        changes = [event for event in self.meta["events"] if event["kind"] == "role"]
        read = [event for event in changes if any(line.startswith("had just read from") for line in event["detail"])]
        self.expect(len(read) > 0, f"none of {len(changes)} changes of role says what was read before it")

    def speed(self) -> float:
        """Frames a second while the run plays with everything on."""
        self.page.evaluate("() => { desimReplay.follow(-1); desimReplay.seek(0); desimReplay.play(); scrollTo(0, 0); }")
        self.page.wait_for_timeout(300)
        first, start = self.page.evaluate("() => [desimReplay.drawn(), performance.now()]")
        self.page.wait_for_timeout(3000)
        last, end = self.page.evaluate("() => [desimReplay.drawn(), performance.now()]")
        self.page.evaluate("() => desimReplay.pause()")
        return (last - first) * 1000 / (end - start)


def drive(context: BrowserContext, path: pathlib.Path, data: Data, width: str, pictures: pathlib.Path) -> tuple[float, list[str]]:
    page = context.new_page()
    address = path.resolve().as_uri()
    found: list[str] = []
    page.on("console", lambda message: found.append(f"console: {message.text}") if message.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: found.append(f"error: {error}"))
    page.on("dialog", lambda dialog: (found.append(f"dialog: {dialog.message}"), dialog.dismiss()))
    page.on("request", lambda request: None if request.url.split("#")[0] == address or request.url.startswith(("data:", "blob:"))
            else found.append(f"request: {request.url}"))
    page.goto(address)
    page.evaluate("() => desimReplay.ready")
    driver = Driver(page, data, found)
    driver.expect(driver.get("playing()"), "it does not start playing")
    rate = driver.speed()
    touch = width == "phone"
    for check in ([] if touch else [driver.data_shown]) + [driver.keys, driver.controls, driver.messages]:
        check()
    driver.following(touch)
    for check in (driver.pinch if touch else driver.video, driver.fragment, driver.events, driver.reliance):
        check()
    driver.expect((overflow := page.evaluate(OVERFLOW)) <= 0, f"the page is {overflow} px wider than its window")
    found.extend(page.evaluate(CROWDED))
    event = next((event["t"] for event in data.meta["events"] if event["kind"] == "suspicion" and event["t"] > data.meta["duration_s"] / 3), 1)
    driver.seek(event)
    page.evaluate("() => scrollTo(0, 0)")
    page.wait_for_timeout(200)
    for part, whole in (("-top", False), ("", True)):
        page.screenshot(path=str(pictures / f"{path.resolve().parent.name}-{path.stem}-{width}{part}.png"), full_page=whole)
    page.emulate_media(reduced_motion="reduce")
    page.goto("about:blank")
    page.goto(address)
    page.evaluate("() => desimReplay.ready")
    driver.expect(not driver.get("playing()"), "it plays by itself despite reduced motion")
    page.close()
    return rate, found


def main() -> int:
    pictures = pathlib.Path(sys.argv[1])
    pictures.mkdir(parents=True, exist_ok=True)
    wrong = False
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        for path in map(pathlib.Path, sys.argv[2:]):
            data = Data(path)
            for width, (wide, high) in WIDTHS.items():
                phone = width == "phone"
                context = browser.new_context(offline=True, viewport={"width": wide, "height": high}, has_touch=phone, accept_downloads=True)
                rate, found = drive(context, path, data, width, pictures)
                context.close()
                wrong = wrong or bool(found)
                print(f"{path.resolve().parent.name}/{path.name}, {width}: {data.meta['robots']} robots: {rate:.0f} frames a second, {len(found)} faults", flush=True)
                for fault in found:
                    print(f"  {fault}", flush=True)
        browser.close()
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main())

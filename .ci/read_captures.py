"""Packet captures against the tables of the same part of the same run: `read_captures.py DESIM DISSECTOR RESULTS...`.

Each folder of results has `trace/` and `trace.pcapng`. Any difference is said, and the exit status is 1.
"""

import collections
import json
import pathlib
import re
import subprocess
import sys

import polars

FATES = {0: "delivered", 1: "lost", 2: "in_flight", 3: "strayed"}
FAULTS = []


def fault(folder: pathlib.Path, what: str) -> None:
    FAULTS.append(f"{folder.name}: {what}")


FRAME = ["frame.interface_name", "frame.time_epoch", "frame.len", "desim.topic", "frame.comment", "_ws.malformed", "desim.undescribed", "desim.payload"]
FATE = ["desim_fate." + name for name in ("sender", "receiver", "message", "topic", "fate")]


def tshark(dissector: str, capture: pathlib.Path, fields: list[str]) -> list[dict[str, list[str]]]:
    """For each packet the values of each field."""
    command = ["tshark", "-X", f"lua_script:{dissector}", "-r", str(capture), "-T", "fields"]
    command += ["-E", "occurrence=a", "-E", "aggregator=;", "-E", "separator=/t"]
    for field in fields:
        command += ["-e", field]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    noise = [line for line in done.stderr.splitlines() if "Running as user" not in line]
    if noise:
        raise SystemExit(f"{capture}: tshark says: {noise}")
    rows = (line.split("\t") for line in done.stdout.splitlines())
    return [{field: cell.split(";") if cell else [] for field, cell in zip(fields, row, strict=True)} for row in rows]


def nanoseconds(seconds: float) -> int:
    return round(seconds * 1e9)


def stamp(text: str) -> int:
    whole, part = text.split(".")
    return int(whole) * 1_000_000_000 + int(part.ljust(9, "0"))


def frames(folder: pathlib.Path, air: list[dict[str, list[str]]]) -> None:
    table = polars.read_parquet(folder / "trace/frames.parquet")
    messages = polars.read_parquet(folder / "trace/messages.parquet")
    bandwidth = polars.read_parquet(folder / "bandwidth.parquet").filter(direction="tx", trial=0)
    if not air:
        return fault(folder, "no frames")

    topics = collections.Counter(topic for packet in air for topic in packet["desim.topic"])
    sent = {row["topic"]: row["frames"] for row in bandwidth.group_by("topic").agg(polars.col("frames").sum()).to_dicts()}
    accounted = bandwidth["payload_bytes"].sum() + bandwidth["header_bytes"].sum()
    if (folder / "part").exists():
        if not all(topics[topic] <= sent[topic] for topic in topics):
            fault(folder, f"frames by topic: {dict(topics)} captured, {sent} accounted")
    elif topics != sent:
        fault(folder, f"frames by topic: {dict(topics)} captured, {sent} accounted")
    elif table["bytes"].sum() != accounted:
        fault(folder, f"{table['bytes'].sum()} bytes in the log, {accounted} accounted")

    captured = [(stamp(packet["frame.time_epoch"][0]), int(packet["frame.len"][0])) for packet in air]
    constant, more = stated(folder)
    logged = [
        (nanoseconds(row["time_s"]), row["bytes"] - constant + (row["messages"] - 1) * more) for row in table.iter_rows(named=True)
    ]
    if captured != logged:
        pair = next((pair for pair in zip(captured, logged) if pair[0] != pair[1]), (len(captured), len(logged)))
        fault(folder, f"times and lengths of frames: {pair}")

    for packet in air:
        if packet["_ws.malformed"] or packet["desim.undescribed"]:
            return fault(folder, f"malformed: {packet}")
    payloads = [payload for packet in air for payload in packet["desim.payload"]]
    if payloads != [payload for payload in messages["payload"] if payload]:
        fault(folder, "payloads differ")
    told = re.compile(r"(\d+) of (\d+) delivered")
    for packet, row in zip(air, table.iter_rows(named=True)):
        found = told.match(packet["frame.comment"][0])
        if not found or [int(found[1]), int(found[2])] != [row["delivered"], row["offered"]]:
            return fault(folder, f"comment {packet['frame.comment']} of {row}")


def stated(folder: pathlib.Path) -> tuple[int, int]:
    """What the capture says of its lengths: the constant, and bytes more for each further message."""
    words = subprocess.run(["capinfos", "-k", str(folder / "trace.pcapng")], capture_output=True, text=True, check=True).stdout
    constant = re.search(r"captured length = accounted bytes - \((-?\d+)\)", words)
    more = re.search(r"and (\d+) more for each message", words)
    if not constant:
        raise SystemExit(f"{folder}: the capture states no constant: {words}")
    return int(constant[1]), int(more[1]) if more else 0


def described(folder: pathlib.Path, dissector: str) -> dict[str, str]:
    """The fields of the protocol's payloads: what desim calls them, by what tshark does."""
    protocol = json.loads((folder / "manifest.json").read_text())["scenario"]["protocol"]
    kind = protocol if isinstance(protocol, str) else next(iter(protocol))
    script = pathlib.Path(dissector).read_text()
    return dict(re.findall(rf'ProtoField\.\w+\("(desim\.{kind.lower()}\.[a-z0-9_]+)", "([^"]*)"', script))


def contents(folder: pathlib.Path, air: list[dict[str, list[str]]], known: dict[str, str]) -> None:
    """Fields of payloads as tshark names them, against those that desim reads: each name, each number, in order."""
    order = polars.read_parquet(folder / "trace/frames.parquet")
    messages = polars.read_parquet(folder / "trace/messages.parquet")
    names = sorted(known.values(), key=len, reverse=True)
    words = collections.defaultdict(lambda: collections.defaultdict(list))
    for row in messages.iter_rows(named=True):
        frame = (row["sender"], row["frame"])
        for field in filter(None, row["content"].split(", ")):
            # A name such as `number` may begin another, `number of robots`: the longest that fits.
            name = next(name for name in names if field.startswith(name + " "))
            words[frame][name].append(field[len(name) + 1 :])
    read = collections.Counter(name for fields in words.values() for name, values in fields.items() for _ in values)
    named = 0
    for packet, row in zip(air, order.iter_rows(named=True)):
        expected = words[row["sender"], row["frame"]]
        for field, name in known.items():
            values, wanted = packet[field], expected.get(name, [])
            numbers = [want for want in wanted if re.fullmatch(r"-?\d+", want)]
            same = len(wanted) == len(values)
            if same and len(numbers) == len(wanted):
                same = [int(value, 0) for value in values] == [int(want) for want in numbers]
            if not same:
                return fault(folder, f"{field}: tshark has {values}, desim {wanted} in {row}")
            named += len(values)
    if named != read.total() or named == 0:
        fault(folder, f"{named} fields named by tshark, {read.total()} by desim")
    print(f"{folder.name}: {len(air)} frames, {named} fields of {len(read)} names", flush=True)


def fates(folder: pathlib.Path, read: list[dict[str, list[str]]]) -> None:
    copies = polars.read_parquet(folder / "trace/copies.parquet")
    if any(packet["_ws.malformed"] for packet in read):
        return fault(folder, "malformed fates")

    def row(packet: dict[str, list[str]]) -> tuple[int, int, int, str, str]:
        sender, receiver, message, topic, fate = (packet[field][0] for field in FATE)
        return int(sender), int(receiver), int(message), topic, FATES[int(fate)]

    captured = collections.Counter(map(row, read))
    logged = collections.Counter(copies.select("sender", "receiver", "message", "topic", "fate").iter_rows())
    if captured != logged:
        fault(folder, f"fates: {(captured - logged).most_common(2)} captured only, {(logged - captured).most_common(2)} logged only")


def times(folder: pathlib.Path) -> None:
    """Within a capture time does not go back, but for what strayed or is still under way at the end."""
    words = subprocess.run(["capinfos", "-o", str(folder / "trace.pcapng")], capture_output=True, text=True, check=True).stdout
    odd = polars.read_parquet(folder / "trace/copies.parquet").filter(polars.col("fate").is_in(["strayed", "in_flight"]))
    if "True" not in words and odd.is_empty():
        fault(folder, "times go back")


def main() -> None:
    dissector, *folders = sys.argv[2:]
    for folder in map(pathlib.Path, folders):
        known = described(folder, dissector)
        packets = tshark(dissector, folder / "trace.pcapng", FRAME + FATE + list(known))
        air = [packet for packet in packets if packet["frame.interface_name"] == ["air"]]
        frames(folder, air)
        contents(folder, air, known)
        fates(folder, [packet for packet in packets if packet["frame.interface_name"] == ["fates"]])
        times(folder)
    for line in FAULTS:
        print(line, file=sys.stderr)
    sys.exit(bool(FAULTS))


main()

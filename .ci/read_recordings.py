#!/usr/bin/env python3
"""Holds the recordings in a results folder, trace.mcap and trace.json, against the tables in its folder trace, and against what their formats ask for.

Usage: read_recordings.py RESULTS. Exit status 1 with the first thing that is wrong.
"""

import collections
import json
import math
import pathlib
import random
import re
import struct
import subprocess
import sys
import tempfile

import foxglove_schemas_protobuf as published
import polars
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

KINDS = {1: ("B", 1), 5: ("I", 4), 7: ("f", 4)}
LOGGED = {"fails", "recovers", "links_fail", "links_recover", "suspects", "trusts", "enters", "serves", "learns"}
LEVELS = {"fails": 4, "links_fail": 4, "suspects": 3}


def demand(holds: bool, words: str) -> None:
    if not holds:
        sys.exit(f"recordings: {words}")


def nanoseconds(seconds: float) -> int:
    return round(seconds * 1e9)


# --- MCAP ---


def point_cloud(cloud) -> list[dict]:
    """Its points, read by its own fields."""
    points = []
    for begin in range(0, len(cloud.data), cloud.point_stride):
        point = {}
        for field in cloud.fields:
            letter, size = KINDS[field.type]
            place = begin + field.offset
            demand(field.offset + size <= cloud.point_stride, f"field {field.name} leaves its point")
            (point[field.name],) = struct.unpack("<" + letter, cloud.data[place : place + size])
        points.append(point)
    return points


def read_mcap(path: pathlib.Path) -> tuple[dict, dict]:
    """Messages by channel, as (time, message), and schemas by name."""
    messages, schemas = collections.defaultdict(list), {}
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()], validate_crcs=True)
        demand(reader.get_header().profile == "", "the profile is not empty")
        summary = reader.get_summary()
        for chunk in summary.chunk_indexes:
            demand(chunk.compression == "zstd", "a chunk is not zstd")
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            schemas[schema.name] = schema
            messages[channel.topic].append((message.log_time, decoded))
        demand(
            sum(map(len, messages.values())) == summary.statistics.message_count,
            "there are not as many messages as the summary says",
        )
    return messages, schemas


def check_schemas(schemas: dict) -> None:
    """Every message type in use, and all within, has the fields that Foxglove publishes."""
    for name, schema in schemas.items():
        files = descriptor_pb2.FileDescriptorSet.FromString(schema.data)
        pool = descriptor_pool.DescriptorPool()
        waiting = list(files.file)
        while waiting:
            ready = [file for file in waiting if all(is_in(pool, needed) for needed in file.dependency)]
            demand(bool(ready), f"the schema of {name} lacks a file")
            for file in ready:
                pool.Add(file)
                waiting.remove(file)
        ours = pool.FindMessageTypeByName(name)
        module = __import__(f"foxglove_schemas_protobuf.{name.split('.')[1]}_pb2", fromlist=["_"])
        theirs = module.DESCRIPTOR.message_types_by_name[name.split(".")[1]]
        compare(ours, theirs, set())


def is_in(pool: descriptor_pool.DescriptorPool, file: str) -> bool:
    try:
        pool.FindFileByName(file)
    except KeyError:
        return False
    return True


def compare(ours, theirs, seen: set) -> None:
    if ours.full_name in seen:
        return
    seen.add(ours.full_name)
    shape = lambda field: (field.name, field.number, field.type, field.is_repeated)
    demand(
        [shape(field) for field in ours.fields] == [shape(field) for field in theirs.fields],
        f"{ours.full_name} has other fields than Foxglove's",
    )
    for mine, their in zip(ours.fields, theirs.fields):
        if mine.message_type:
            demand(mine.message_type.full_name == their.message_type.full_name, f"{ours.full_name}.{mine.name} is another message")
            compare(mine.message_type, their.message_type, seen)
        if mine.enum_type:
            values = [[(value.name, value.number) for value in one.enum_type.values] for one in (mine, their)]
            demand(values[0] == values[1], f"{ours.full_name}.{mine.name} has other values")


def check_whole(message, where: str) -> None:
    """Every message within a message is there, zeros too."""
    for field in message.DESCRIPTOR.fields:
        if not field.message_type:
            continue
        if field.is_repeated:
            for part in getattr(message, field.name):
                check_whole(part, f"{where}.{field.name}")
        else:
            demand(message.HasField(field.name), f"{where}.{field.name} is left out")
            check_whole(getattr(message, field.name), f"{where}.{field.name}")


def check_times(messages: dict) -> None:
    for topic, told in messages.items():
        for at, message in told:
            stamps = [message] if hasattr(message, "timestamp") else getattr(message, "entities", getattr(message, "transforms", None))
            for stamp in stamps:
                time = stamp.timestamp
                # Foxglove's own time or Google's.
                seconds = time.seconds if hasattr(time, "seconds") else time.sec
                nanos = time.nanos if hasattr(time, "nanos") else time.nsec
                demand(seconds * 10**9 + nanos == at, f"a message of {topic} has another time than its stamp")


def check_places(messages: dict, places: polars.DataFrame, events: polars.DataFrame, roles: list[str], disk: float | None) -> None:
    robots = dict(messages["/robots"])
    links = dict(messages["/links"])
    frames = dict(messages["/tf"])
    times = sorted({nanoseconds(time) for time in places["time_s"].unique()})
    demand(sorted(robots) == times, "robots are shown at other times than places.parquet has")
    demand(sorted(links) == times and sorted(frames) == times, "links or frames are shown at other times than robots")
    by_time = {nanoseconds(time): rows for (time,), rows in places.partition_by("time_s", as_dict=True).items()}
    ails = [(nanoseconds(time), robot, 1 if event == "fails" else -1) for time, robot, event in events.select("time_s", "robot", "event").iter_rows() if event in ("fails", "recovers")]
    for at in random.Random(13).sample(times, 10):
        points, rows = point_cloud(robots[at]), by_time[at].sort("robot")
        demand([point["robot"] for point in points] == rows["robot"].to_list(), f"robots are not in order at {at} ns")
        for point, (x, y, role) in zip(points, rows.select("x_m", "y_m", "role").iter_rows()):
            demand(abs(point["x"] - x) < 1e-5 and abs(point["y"] - y) < 1e-5 and point["z"] == 0, f"robot {point['robot']} is elsewhere at {at} ns")
            demand(roles[point["role"]] == role, f"robot {point['robot']} has another role at {at} ns")
            # What happens at that very instant may be told before or after.
            ailments = {sum(by for time, robot, by in ails if robot == point["robot"] and (time < at or (then and time == at))) for then in (0, 1)}
            demand(point["well"] in {int(count == 0) for count in ailments}, f"robot {point['robot']} is not as well as it should be at {at} ns")
        check_frames(frames[at], rows)
        check_links(links[at], rows, disk)


def check_frames(message, rows: polars.DataFrame) -> None:
    for frame, (robot, x, y, heading) in zip(message.transforms, rows.select("robot", "x_m", "y_m", "heading_rad").iter_rows(), strict=True):
        demand(frame.child_frame_id == f"robot_{robot}" and frame.parent_frame_id == "arena", "a frame has another name")
        demand((frame.translation.x, frame.translation.y) == (x, y), f"the frame of robot {robot} is elsewhere")
        turn = 2 * math.atan2(frame.rotation.z, frame.rotation.w)
        demand(abs(math.remainder(turn - heading, math.tau)) < 1e-9, f"the frame of robot {robot} is turned otherwise")


def check_links(message, rows: polars.DataFrame, disk: float | None) -> None:
    places = list(rows.select("x_m", "y_m").iter_rows())
    (entity,) = message.entities
    drawn = []
    for lines in entity.lines:
        demand([(point.x, point.y) for point in lines.points] == places, "lines have other points than robots")
        demand(len(lines.indices) > 0, "lines without indices join all robots")
        drawn += list(zip(lines.indices[::2], lines.indices[1::2]))
    demand(len(set(drawn)) == len(drawn) and all(a < b < len(places) for a, b in drawn), "a link is there twice, or of no robot")
    if disk is None:
        return
    near = {(a, b) for b in range(len(places)) for a in range(b) if math.dist(places[a], places[b]) <= disk * (1 + 1e-9)}
    demand(set(drawn) == near, f"links are not those within {disk} m")


def check_events(messages: dict, events: polars.DataFrame) -> None:
    told = collections.Counter()
    for at, log in messages["/events"]:
        told[(at, log.name, log.message, log.level)] += 1
    expected = collections.Counter()
    for row in events.iter_rows(named=True):
        if row["event"] in LOGGED:
            name = "links" if row["robot"] is None else f"robot {row['robot']}"
            expected[(nanoseconds(row["time_s"]), name, words(row), LEVELS.get(row["event"], 2))] += 1
    wrong = next(iter((told - expected) + (expected - told)), None)
    demand(wrong is None, f"events are not those of events.parquet: {wrong}")


def words(row: dict) -> str:
    about, number, name = row["about"], row["number"], row["name"]
    return {
        "fails": f"fails: {name}",
        "recovers": f"recovers: {name}",
        "links_fail": f"fail: {name}",
        "links_recover": f"recover: {name}",
        "suspects": f"suspects robot {about}, last heard at {re.sub(r'[.]0$', '', repr(row['value']))} s",
        "trusts": f"trusts robot {about} again",
        "enters": f"is {name} now",
        "serves": f"works for no target" if number is None else f"works for target {number}",
        "learns": f"begins rumour {number}" if about is None else f"learns rumour {number} from robot {about}",
    }[row["event"]]


def check_rerun(path: pathlib.Path) -> None:
    rerun = pathlib.Path(sys.executable).with_name("rerun")
    with tempfile.TemporaryDirectory() as folder:
        rrd = pathlib.Path(folder) / "x.rrd"
        for command in (["mcap", "info", path], ["mcap", "check", path], ["mcap", "convert", path, "-o", rrd, "--application-id", "desim"], ["rrd", "verify", rrd]):
            done = subprocess.run([rerun, *map(str, command)], capture_output=True, text=True, check=False)
            said = done.stdout + done.stderr
            demand(done.returncode == 0, f"rerun {' '.join(map(str, command))}: {said}")
            bad = [line for line in said.splitlines() if re.search(r"warn|error", line.replace("without error", ""), re.IGNORECASE)]
            demand(not bad, f"rerun {' '.join(map(str, command[:2]))} says: {bad[:3]}")


# --- Perfetto ---

Slice = collections.namedtuple("Slice", "begin end name cat args")


def read_perfetto(path: pathlib.Path) -> list[dict]:
    with path.open(encoding="utf-8") as file:
        trace = json.load(file)
    demand(trace["displayTimeUnit"] == "ns", "the unit of times is not ns")
    events = trace["traceEvents"]
    for event in events:
        demand(event["ph"] in "BEXCMsfbe", f"there is no phase {event['ph']}")
        demand(event["pid"] > 0 and event["tid"] > 0, "process 0 is somebody else's")
        if event["ph"] != "M":
            time = event["ts"] * 1000
            demand(time >= 0 and abs(time - round(time)) < 1e-3, f"{event['ts']} µs is no whole count of nanoseconds")
    return events


def ns(micros: float) -> int:
    return round(micros * 1000)


def tracks(events: list[dict]) -> dict:
    """Slices by track, after a look at whether they nest as the format asks for."""
    order = sorted((event for event in events if event["ph"] in "BEX"), key=lambda event: ns(event["ts"]))
    open_slices, found, owners = collections.defaultdict(list), collections.defaultdict(list), {}
    for event in order:
        at, track = ns(event["ts"]), event["tid"]
        demand(owners.setdefault(track, event["pid"]) == event["pid"], f"thread {track} belongs to two processes")
        stack = open_slices[track]
        # What readers see of microseconds may be a nanosecond less.
        while stack and stack[-1][0] is not None and stack[-1][0] < at:
            stack.pop()
        if event["ph"] == "E":
            demand(bool(stack) and stack[-1][0] is None, f"an end without a beginning on track {track}")
            begin = stack.pop()[1]
            found[track].append(Slice(ns(begin["ts"]), at, begin["name"], begin["cat"], begin.get("args", {})))
            continue
        end = at + ns(event["dur"]) if event["ph"] == "X" else None
        for outer, _ in stack:
            demand(outer is None or (end is not None and end <= outer), f"slices on track {track} overlap at {at} ns and do not nest")
        demand(end is None or not any(outer is not None for outer, _ in stack), f"a slice on track {track} should lie on a lane of its own")
        stack.append((end, event))
        if end is not None:
            found[track].append(Slice(at, end, event["name"], event["cat"], event.get("args", {})))
    for track, stack in open_slices.items():
        demand(all(end is not None for end, _ in stack), f"a slice on track {track} does not end")
    return found


def check_flows(events: list[dict], slices: dict) -> int:
    begins = {track: sorted(slices[track]) for track in slices}
    ends = collections.defaultdict(list)
    for place, event in enumerate(events):
        if event["ph"] in "sf":
            ends[event["id"]].append((place, event))
            demand(any(one.begin <= ns(event["ts"]) <= one.end for one in near(begins.get(event["tid"], []), ns(event["ts"]))), f"flow {event['id']} ends in no slice")
            demand(event["ph"] == "s" or event.get("bp") == "e", f"flow {event['id']} leads to the next slice")
    for number, both in ends.items():
        starts = [(ns(event["ts"]), place) for place, event in both if event["ph"] == "s"]
        leads = [(ns(event["ts"]), place) for place, event in both if event["ph"] == "f"]
        demand(len(starts) == 1 and leads, f"flow {number} has {len(starts)} beginnings and {len(leads)} ends")
        demand(all(starts[0] < lead for lead in leads), f"flow {number} leads backwards")
    return len(ends)


def near(ordered: list[Slice], at: int) -> list[Slice]:
    import bisect

    place = bisect.bisect_right(ordered, at, key=lambda one: one.begin)
    return ordered[max(0, place - 2) : place]


def check_apart(events: list[dict]) -> int:
    open_at = {}
    apart = sorted((event for event in events if event["ph"] in "be"), key=lambda event: ns(event["ts"]))
    for event in apart:
        key = (event["pid"], event["cat"], event["id"], event["name"])
        if event["ph"] == "b":
            demand(key not in open_at, f"{event['name']} begins twice")
            open_at[key] = event["ts"]
        else:
            demand(open_at.pop(key, None) is not None, f"{event['name']} ends and has not begun")
    demand(not open_at, f"{next(iter(open_at), None)} does not end")
    return len(apart) // 2


def check_counters(events: list[dict]) -> None:
    counters = [event for event in events if event["ph"] == "C"]
    demand(bool(counters), "there are no counters")
    for event in counters:
        demand(all(math.isfinite(value) for value in event["args"].values()), f"{event['name']} is no number")


def check_counts(slices: dict, tables: dict) -> None:
    kinds = collections.Counter()
    for one in (one for track in slices.values() for one in track):
        kinds[(one.cat, one.args.get("fate"))] += 1
        if one.cat == "hears":
            demand((" lost: " in one.name) == (one.args["fate"] == "lost"), f"{one.name} is {one.args['fate']}")
    demand(kinds[("says", None)] == tables["frames"].height, "there are not as many slices of frames as frames")
    for fate in ("delivered", "lost", "strayed"):
        rows = tables["copies"].filter(polars.col("fate") == fate).height
        demand(kinds[("hears", fate)] == rows, f"{kinds[('hears', fate)]} copies are {fate}, and not {rows}")
    suspects = tables["events"].filter(polars.col("event") == "suspects").height
    demand(kinds[("suspects", None)] == suspects, "there are not as many suspicions as events")


def check_said(events: list[dict], slices: dict, tables: dict) -> None:
    """Frames, by who said them, as the how manyth, and from when on."""
    owners = {event["tid"]: event["pid"] for event in events}
    drawn = {(owners[track] - 1, one.args["frame"]): one.begin for track, all_of_it in slices.items() for one in all_of_it if one.cat == "says"}
    for row in tables["frames"].iter_rows(named=True):
        begin = row["time_s"] if row["began_s"] is None else row["began_s"]
        demand(drawn.get((row["sender"], row["frame"])) == nanoseconds(begin), f"frame {row['frame']} of robot {row['sender']} is drawn elsewhere")


def check_roles(events: list[dict], slices: dict, tables: dict) -> None:
    """At every look at places, each robot's role is the slice that is there."""
    owners = {event["tid"]: event["pid"] for event in events}
    roles = collections.defaultdict(list)
    for track, all_of_it in slices.items():
        for one in all_of_it:
            if one.cat == "role":
                roles[owners[track] - 1].append(one)
    for time, robot, role in tables["places"].select("time_s", "robot", "role").iter_rows():
        at = nanoseconds(time)
        then = {one.name for one in roles[robot] if one.begin <= at <= one.end}
        demand(role in then, f"robot {robot} is {role} at {at} ns, and drawn as {then}")


def main(folder: pathlib.Path) -> None:
    manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    disk = manifest["scenario"]["radio"].get("range")
    tables = {path.stem: polars.read_parquet(path) for path in sorted((folder / "trace").glob("*.parquet"))}
    messages, schemas = read_mcap(folder / "trace.mcap")
    demand(set(messages) == {"/robots", "/links", "/scene", "/tf", "/events"} or "/events" not in messages, "a channel is empty")
    check_schemas(schemas)
    for topic, told in messages.items():
        for _, message in told:
            check_whole(message, topic)
    check_times(messages)
    with (folder / "trace.mcap").open("rb") as file:
        about = next(iter(make_reader(file).iter_metadata())).metadata
    check_places(messages, tables["places"], tables["events"], about["roles"].split(","), disk)
    demand(len(messages["/scene"]) == 1, "what stands still is not there once")
    check_events(messages, tables["events"])
    check_rerun(folder / "trace.mcap")
    print(f"{folder.name}: trace.mcap, {sum(map(len, messages.values()))} messages in {len(messages)} channels")

    events = read_perfetto(folder / "trace.json")
    slices = tracks(events)
    flows = check_flows(events, slices)
    suspicions = check_apart(events)
    check_counters(events)
    check_counts(slices, tables)
    check_said(events, slices, tables)
    check_roles(events, slices, tables)
    print(f"{folder.name}: trace.json, {len(events)} events on {len(slices)} tracks, {flows} flows, {suspicions} suspicions")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))

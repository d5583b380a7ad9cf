// What holds at a moment besides positions: roles, faults, suspicions and links. All of it moves both ways in time.

/** The moment that is shown, and what the person has chosen. */
const now = {
  t: 0, frame: 0, playing: false, speed: 1, followed: -1, event: -1, drawn: 0,
  showLinks: true, showMessages: true, showNumbers: false, showTrail: true, keepCentred: false,
  worldX: new Float64Array(robots), worldY: new Float64Array(robots),
};

/** Times in the data are single precision: a change at 40.2 s must count when the page stands at 40.2 s. */
const slack = t => t + 1e-5 + t * 1e-7;

/** The number of items of a sorted array, from the first, that are at or before a time. */
function countUntil(times, t, length = times.length) {
  let low = 0;
  let high = length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle + 1; else high = middle;
  }
  return low;
}

/** Counts per robot that go up and down over time, such as how many suspect it. */
class Tally {
  constructor(changes) {
    changes.sort((a, b) => a[0] - b[0]);
    this.t = Float64Array.from(changes, change => change[0]);
    this.robot = Uint32Array.from(changes, change => change[1]);
    this.by = Int8Array.from(changes, change => change[2]);
    this.at = 0;
    this.value = new Int32Array(robots);
  }

  move(t) {
    while (this.at < this.t.length && this.t[this.at] <= t) {
      this.value[this.robot[this.at]] += this.by[this.at];
      this.at++;
    }
    while (this.at > 0 && this.t[this.at - 1] > t) {
      this.at--;
      this.value[this.robot[this.at]] -= this.by[this.at];
    }
  }
}

function spans(list, from, to) {
  const changes = [];
  for (const item of list) {
    if (item.robot === null || item.robot === undefined || item.robot >= robots) continue;
    changes.push([from(item), item.robot, 1]);
    const until = to(item);
    if (until !== null && until !== undefined) changes.push([until, item.robot, -1]);
  }
  return new Tally(changes);
}

const failed = spans(meta.faults, fault => fault.from, fault => fault.to);
const suspected = spans(meta.events.filter(event => event.kind === 'suspicion'), event => event.t, event => event.until);

/** Of each robot that ever relies on others, since when on which. */
const relies = new Map();
for (const [t, robot, others] of meta.relies) {
  if (!relies.has(robot)) relies.set(robot, { t: [], others: [] });
  relies.get(robot).t.push(t);
  relies.get(robot).others.push(others);
}

/** Whom a robot relies on at a time. */
function reliedOn(changes, t) {
  let low = 0;
  let high = changes.t.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (changes.t[middle] <= t) low = middle + 1; else high = middle;
  }
  return low > 0 ? changes.others[low - 1] : [];
}

const roles = { at: 0, value: new Uint8Array(robots), counts: new Int32Array(meta.roles.length), before: null, shown: meta.roles.map(() => true) };

function prepareRoles() {
  const { role, role_robot } = columns;
  // The role that each change ended, so that time can run backwards.
  roles.before = new Uint8Array(role.length);
  const last = new Int16Array(robots).fill(-1);
  for (let i = 0; i < role.length; i++) {
    const robot = role_robot[i];
    roles.before[i] = last[robot] < 0 ? 0 : last[robot];
    last[robot] = role[i];
  }
  roles.counts[0] = robots;
}

function moveRoles(t) {
  const { role, role_robot, role_t } = columns;
  const change = (robot, to) => {
    roles.counts[roles.value[robot]]--;
    roles.counts[to]++;
    roles.value[robot] = to;
  };
  while (roles.at < role.length && role_t[roles.at] <= t) {
    change(role_robot[roles.at], role[roles.at]);
    roles.at++;
  }
  while (roles.at > 0 && role_t[roles.at - 1] > t) {
    roles.at--;
    change(role_robot[roles.at], roles.before[roles.at]);
  }
}

/** The links at the frame that is shown, as pairs of robots. */
const links = { frame: -1, sample: -1, length: 0, a: new Uint32Array(1024), b: new Uint32Array(1024), places: new Map(), marks: new Map() };
const linksStored = meta.range_m === null && meta.links !== null;
const linksKnown = meta.range_m !== null || linksStored;

function roomForLinks(length) {
  if (length <= links.a.length) return;
  for (const side of ['a', 'b']) {
    const larger = new Uint32Array(Math.max(length, links.a.length * 2));
    larger.set(links[side]);
    links[side + 'Next'] = larger;
  }
  links.a = links.aNext;
  links.b = links.bNext;
}

// The grid of cells as wide as the range: only robots in neighbouring cells can be linked.
const grid = { head: new Int32Array(0), next: new Int32Array(robots), column: new Int32Array(robots), row: new Int32Array(robots) };

function linksWithinRange() {
  const quantum = meta.frames.quantum_m;
  const { x, y } = cursor;
  const range = meta.range_m / quantum;
  let lowX = Infinity, lowY = Infinity, highX = -Infinity, highY = -Infinity;
  for (let robot = 0; robot < robots; robot++) {
    lowX = Math.min(lowX, x[robot]); highX = Math.max(highX, x[robot]);
    lowY = Math.min(lowY, y[robot]); highY = Math.max(highY, y[robot]);
  }
  // At most 1,024 cells a side, for a range that is tiny against the arena.
  const cell = Math.max(range, (highX - lowX) / 1024, (highY - lowY) / 1024, 1);
  const wide = Math.floor((highX - lowX) / cell) + 1;
  const high = Math.floor((highY - lowY) / cell) + 1;
  if (grid.head.length < wide * high) grid.head = new Int32Array(wide * high * 2);
  grid.head.fill(-1, 0, wide * high);
  let length = 0;
  for (let robot = 0; robot < robots; robot++) {
    const column = Math.floor((x[robot] - lowX) / cell);
    const row = Math.floor((y[robot] - lowY) / cell);
    // Only robots that are already in the grid are looked at, so each pair is found once.
    for (let r = Math.max(0, row - 1); r <= Math.min(high - 1, row + 1); r++) {
      for (let c = Math.max(0, column - 1); c <= Math.min(wide - 1, column + 1); c++) {
        for (let other = grid.head[r * wide + c]; other >= 0; other = grid.next[other]) {
          const distanceX = x[robot] - x[other];
          const distanceY = y[robot] - y[other];
          if (distanceX * distanceX + distanceY * distanceY > range * range) continue;
          if (length === links.a.length) roomForLinks(length + 1);
          links.a[length] = other;
          links.b[length++] = robot;
        }
      }
    }
    grid.next[robot] = grid.head[row * wide + column];
    grid.head[row * wide + column] = robot;
  }
  links.length = length;
}

function toggleSample(sample) {
  const { toggle_first, toggle_a, toggle_b } = columns;
  for (let i = toggle_first[sample]; i < toggle_first[sample + 1]; i++) {
    const key = toggle_a[i] * robots + toggle_b[i];
    const place = links.places.get(key);
    if (place === undefined) {
      roomForLinks(links.length + 1);
      links.places.set(key, links.length);
      links.a[links.length] = toggle_a[i];
      links.b[links.length++] = toggle_b[i];
    } else {
      // The last pair takes the place of the one that goes.
      links.places.delete(key);
      const last = --links.length;
      if (place !== last) {
        links.a[place] = links.a[last];
        links.b[place] = links.b[last];
        links.places.set(links.a[place] * robots + links.b[place], place);
      }
    }
  }
}

function storedLinks(frame) {
  const to = clamp(Math.floor(frame / meta.links.every_frames), 0, meta.links.samples - 1);
  const mark = Math.floor(to / MARK) * MARK;
  if (links.marks.has(mark) && Math.abs(to - links.sample) > to - mark) {
    const kept = links.marks.get(mark);
    links.length = kept.a.length;
    roomForLinks(links.length);
    links.a.set(kept.a);
    links.b.set(kept.b);
    links.places.clear();
    for (let i = 0; i < links.length; i++) links.places.set(links.a[i] * robots + links.b[i], i);
    links.sample = mark;
  }
  while (links.sample < to) {
    toggleSample(++links.sample);
    if (links.sample % MARK === 0 && !links.marks.has(links.sample)) {
      links.marks.set(links.sample, { a: links.a.slice(0, links.length), b: links.b.slice(0, links.length) });
    }
  }
  while (links.sample > to) toggleSample(links.sample--);
}

/** Brings everything to a time. */
function moveState(t) {
  now.frame = placeRobots(t, now.worldX, now.worldY);
  const until = slack(t);
  moveRoles(until);
  failed.move(until);
  suspected.move(until);
  if (linksKnown && links.frame !== now.frame) {
    if (linksStored) storedLinks(now.frame); else linksWithinRange();
    links.frame = now.frame;
  }
}

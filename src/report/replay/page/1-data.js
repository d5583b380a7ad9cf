'use strict';
// What was handed in: the description of the run, and its packed columns.

const meta = JSON.parse(document.getElementById('meta').textContent);
// A run without roles has one, so that its robots have a colour.
if (meta.roles.length === 0) { meta.roles = ['robot']; meta.role_colours = ['#0072b2']; }
const robots = meta.robots;
const duration = meta.duration_s;
const frameCount = meta.frames.count;
const steps = Math.max(0, frameCount - 1);
const ink = '#333333';

const byId = id => document.getElementById(id);

/** Puts words on the page. Words of a run may be hostile, so they never become markup. */
function setText(element, words) {
  if (element.textContent !== words) element.textContent = words;
}

/** A new element with words and a class. */
function make(tag, words, kind) {
  const element = document.createElement(tag);
  if (words !== undefined) element.textContent = words;
  if (kind) element.className = kind;
  return element;
}

const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
const grouped = new Intl.NumberFormat('en');
const seconds = t => t.toFixed(meta.frames.every_s < 0.05 ? 3 : 2) + ' s';
const count = (number, word) => grouped.format(number) + ' ' + word + (number === 1 ? '' : 's');
/** Names of causes and roles come as in the files: half_duplex reads better as two words. */
const words = id => String(id).replaceAll('_', ' ');

/** The packed columns by name. An absent column is an empty one. */
const columns = {};

function decodeBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  // In pieces: a string of the whole file as well as its bytes would double the memory.
  const clean = text.replace(/\s+/g, '');
  const bytes = new Uint8Array(Math.floor(clean.length * 3 / 4));
  let filled = 0;
  for (let from = 0; from < clean.length; from += 1 << 20) {
    const piece = atob(clean.slice(from, from + (1 << 20)));
    for (let i = 0; i < piece.length; i++) bytes[filled++] = piece.charCodeAt(i);
  }
  return bytes.subarray(0, filled);
}

async function unpack() {
  const holder = byId('data');
  const packed = decodeBase64(holder.textContent.trim());
  holder.textContent = '';
  if (typeof DecompressionStream === 'undefined') throw new Error('This browser cannot inflate the data: it is older than 2023.');
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  const buffer = await new Response(stream).arrayBuffer();
  const column = (name, Type) => {
    const place = meta.sections[name];
    columns[name] = place ? new Type(buffer, place[0], Math.floor(place[1] / Type.BYTES_PER_ELEMENT)) : new Type(0);
  };
  const Step = meta.frames.width === 2 ? Int16Array : Int32Array;
  for (const name of ['x0', 'y0']) column(name, Int32Array);
  for (const name of ['dx', 'dy']) column(name, Step);
  for (const name of ['role_t', 'msg_t']) column(name, Float32Array);
  for (const name of ['role', 'msg_topic', 'copy_fate']) column(name, Uint8Array);
  for (const name of ['role_robot', 'msg_sender', 'msg_bytes', 'msg_first', 'copy_receiver', 'toggle_first', 'toggle_a', 'toggle_b']) {
    column(name, Uint32Array);
  }
  column('copy_late', Uint16Array);
  columns.copy_t = arrivals();
  if (columns.x0.length !== robots || columns.dx.length !== robots * steps) {
    throw new Error('The data of this page do not fit its description.');
  }
}

/** When each copy arrived or was lost: what is stored is how long after its message, in tenths of a millisecond. */
function arrivals() {
  const { msg_t, msg_first, copy_late } = columns;
  const times = new Float32Array(copy_late.length);
  for (let message = 0; message < msg_t.length; message++) {
    for (let copy = msg_first[message]; copy < msg_first[message + 1]; copy++) times[copy] = msg_t[message] + copy_late[copy] * 1e-4;
  }
  return times;
}

/** The time of frame i. The last frame is at the end of the run, even where that is not a whole number of frames. */
const frameTime = i => Math.min(i * meta.frames.every_s, duration);

/** The last frame at or before a time. */
function frameAt(t) {
  if (steps === 0 || t >= frameTime(steps) - 1e-9) return steps;
  return clamp(Math.floor(t / meta.frames.every_s + 1e-6), 0, steps);
}

// Positions are stored as differences. A cursor walks them, and marks every 64 frames keep a jump short.
const MARK = 64;
const cursor = { at: 0, x: null, y: null, marksX: null, marksY: null };

function prepareFrames() {
  const marks = Math.floor(steps / MARK) + 1;
  cursor.x = Int32Array.from(columns.x0);
  cursor.y = Int32Array.from(columns.y0);
  cursor.marksX = new Int32Array(marks * robots);
  cursor.marksY = new Int32Array(marks * robots);
  for (const [first, differences, kept] of [[columns.x0, columns.dx, cursor.marksX], [columns.y0, columns.dy, cursor.marksY]]) {
    for (let robot = 0; robot < robots; robot++) {
      let value = first[robot];
      kept[robot] = value;
      for (let i = 1, from = robot * steps; i <= steps; i++) {
        value += differences[from++];
        if (i % MARK === 0) kept[i / MARK * robots + robot] = value;
      }
    }
  }
}

/** Brings the cursor to a frame. */
function moveFrames(to) {
  const { x, y } = cursor;
  const { dx, dy } = columns;
  const mark = Math.min(Math.round(to / MARK), Math.floor(steps / MARK));
  if (Math.abs(to - mark * MARK) < Math.abs(to - cursor.at)) {
    x.set(cursor.marksX.subarray(mark * robots, (mark + 1) * robots));
    y.set(cursor.marksY.subarray(mark * robots, (mark + 1) * robots));
    cursor.at = mark * MARK;
  }
  while (cursor.at < to) {
    for (let robot = 0, i = cursor.at; robot < robots; robot++, i += steps) { x[robot] += dx[i]; y[robot] += dy[i]; }
    cursor.at++;
  }
  while (cursor.at > to) {
    cursor.at--;
    for (let robot = 0, i = cursor.at; robot < robots; robot++, i += steps) { x[robot] -= dx[i]; y[robot] -= dy[i]; }
  }
}

/** Where the robots are at a time, in metres: on the straight line between two frames. */
function placeRobots(t, outX, outY) {
  const frame = frameAt(t);
  moveFrames(frame);
  const { x, y } = cursor;
  const { dx, dy } = columns;
  const quantum = meta.frames.quantum_m;
  const from = frameTime(frame);
  const part = frame < steps ? clamp((t - from) / (frameTime(frame + 1) - from), 0, 1) : 0;
  if (part < 1e-9) {
    for (let robot = 0; robot < robots; robot++) { outX[robot] = x[robot] * quantum; outY[robot] = y[robot] * quantum; }
  } else {
    for (let robot = 0, i = frame; robot < robots; robot++, i += steps) {
      outX[robot] = (x[robot] + part * dx[i]) * quantum;
      outY[robot] = (y[robot] + part * dy[i]) * quantum;
    }
  }
  return frame;
}

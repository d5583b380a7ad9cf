// Controls, keys, the fragment of the address, and the loop that draws.

const SPEEDS = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100];
const KEYS = [
  ['Space', 'play or pause'], ['← →', 'one frame back or on; ten with Shift'], ['Home, End', 'start, end of the run'],
  [', .', 'slower, faster'], ['f', 'follow the robot nearest the middle, or stop following'], ['c', 'keep the followed robot in the middle'],
  ['l, m, n', 'links, messages, numbers'], ['+ − 0', 'zoom in, out, whole arena'], ['↑ ↓', 'previous, next event (in the list)'], ['?', 'these keys'],
];

function seek(t) {
  now.t = clamp(Number.isFinite(t) ? t : 0, 0, duration);
  list.busyUntil = 0;
  noteFragment(false);
  redraw();
}

function showPlaying() {
  setText(byId('play'), now.playing ? 'Pause' : 'Play');
  setText(byId('speed'), now.speed + '×');
}

function play() {
  if (now.t >= duration) now.t = 0;
  now.playing = true;
  showPlaying();
  redraw();
}

function pause() {
  now.playing = false;
  showPlaying();
  noteFragment(true);
  redraw();
}

/** Steps by frames. Back from between two frames goes to the earlier one. */
function step(by) {
  pause();
  const frame = frameAt(now.t);
  const between = by < 0 && now.t > frameTime(frame) + 1e-6 ? 1 : 0;
  seek(frameTime(clamp(frame + by + between, 0, steps)));
}

function changeSpeed(by) {
  now.speed = SPEEDS[clamp(SPEEDS.indexOf(now.speed) + by, 0, SPEEDS.length - 1)];
  showPlaying();
  redraw();
}

function toggle(id) {
  const box = byId(id);
  if (box.parentElement.hidden) return;
  box.checked = !box.checked;
  box.dispatchEvent(new Event('change'));
}

const fragment = { next: 0, waiting: 0, words: location.hash };

/** Keeps the address up to date. Browsers refuse more than about a hundred changes in half a minute. */
function noteFragment(soon) {
  if (fragment.waiting) return;
  const wait = Math.max(soon ? 50 : 200, fragment.next - performance.now());
  fragment.waiting = setTimeout(() => {
    fragment.waiting = 0;
    fragment.next = performance.now() + 500;
    // An address that somebody has just given is read first: its event is on its way.
    if (location.hash !== fragment.words) return;
    fragment.words = '#t=' + Number(now.t.toFixed(3)) + (now.followed >= 0 ? '&robot=' + now.followed : '');
    if (location.hash !== fragment.words) history.replaceState(null, '', fragment.words);
  }, wait);
}

/** Goes where the address says. True if it names a time. */
function readFragment() {
  fragment.words = location.hash;
  const wanted = new URLSearchParams(location.hash.slice(1));
  const robot = wanted.has('robot') ? Number(wanted.get('robot')) : -1;
  if (robot !== now.followed) follow(robot);
  const named = wanted.has('t') && Number.isFinite(Number(wanted.get('t')));
  if (named) seek(Number(wanted.get('t')));
  return named;
}

function save(blob, ending) {
  const link = make('a');
  link.href = URL.createObjectURL(blob);
  link.download = (meta.name || 'run').replace(/[^\w.-]+/g, '-') + '-' + now.t.toFixed(1) + 's.' + ending;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

let recorder = null;
function record() {
  const button = byId('video');
  if (recorder) { recorder.stop(); return; }
  const pieces = [];
  const kind = ['video/webm;codecs=vp9', 'video/webm'].find(type => MediaRecorder.isTypeSupported(type));
  recorder = new MediaRecorder(scene.captureStream(30), { mimeType: kind, videoBitsPerSecond: 6e6 });
  recorder.addEventListener('dataavailable', event => { if (event.data.size) pieces.push(event.data); });
  recorder.addEventListener('stop', () => {
    for (const track of recorder.stream.getTracks()) track.stop();
    recorder = null;
    setText(button, 'Video');
    button.classList.remove('active');
    save(new Blob(pieces, { type: 'video/webm' }), 'webm');
  });
  recorder.start(1000);
  setText(button, 'Stop video');
  button.classList.add('active');
  if (!now.playing) play();
}

function listen() {
  const press = (id, action) => byId(id).addEventListener('click', action);
  press('play', () => (now.playing ? pause() : play()));
  press('home', () => { pause(); seek(0); });
  press('end', () => { pause(); seek(duration); });
  press('back', event => step(event.shiftKey ? -10 : -1));
  press('on', event => step(event.shiftKey ? 10 : 1));
  press('slower', () => changeSpeed(-1));
  press('faster', () => changeSpeed(1));
  press('fit', () => { setCentred(false); fit(); });
  press('picture', () => scene.toBlob(blob => save(blob, 'png')));
  press('video', record);
  press('help-open', () => byId('help').showModal());
  byId('video').hidden = !(window.MediaRecorder && scene.captureStream && MediaRecorder.isTypeSupported('video/webm'));
  byId('scrub').max = duration;
  byId('scrub').addEventListener('input', event => seek(Number(event.target.value)));
  for (const [id, name] of [['show-links', 'showLinks'], ['show-messages', 'showMessages'], ['show-numbers', 'showNumbers'], ['show-trail', 'showTrail']]) {
    byId(id).addEventListener('change', event => { now[name] = event.target.checked; redraw(); });
  }
  for (const [key, what] of KEYS) {
    const row = make('tr');
    row.append(make('td', key), make('td', what));
    byId('keys').append(row);
  }
  addEventListener('keydown', onKey);
  addEventListener('hashchange', readFragment);
  addEventListener('resize', () => { layOut(); drawStrip(); drawCharts(); });
  listenToScene(robot => follow(robot === now.followed ? -1 : robot));
}

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || byId('help').open) return;
  const target = event.target;
  // Keys that a field or a button needs for itself stay with it. The scrubber steps by frames, as the page does.
  if (target.matches('input[type=number], textarea')) { if (event.key === 'Escape') target.blur(); return; }
  if (event.key === ' ' && target.matches('button, input[type=checkbox]')) return;
  const many = event.shiftKey ? 10 : 1;
  const middle = [view.wide / 2, view.high / 2];
  const actions = {
    ' ': () => (now.playing ? pause() : play()),
    ArrowLeft: () => step(-many), ArrowRight: () => step(many),
    Home: () => { pause(); seek(0); }, End: () => { pause(); seek(duration); },
    ',': () => changeSpeed(-1), '.': () => changeSpeed(1), '<': () => changeSpeed(-1), '>': () => changeSpeed(1),
    l: () => toggle('show-links'), m: () => toggle('show-messages'), n: () => toggle('show-numbers'),
    f: () => follow(now.followed >= 0 ? -1 : robotAt(...middle, Infinity)),
    c: () => setCentred(!now.keepCentred), Escape: () => follow(-1),
    '+': () => zoom(1.25, ...middle), '=': () => zoom(1.25, ...middle), '-': () => zoom(0.8, ...middle), 0: () => { setCentred(false); fit(); },
    '?': () => byId('help').showModal(),
  };
  const action = actions[event.key];
  if (!action) return;
  event.preventDefault();
  action();
}

function describe() {
  setText(byId('title'), meta.name);
  if (meta.question) { setText(byId('question'), meta.question); byId('question').hidden = false; }
  setText(byId('about'), [count(robots, 'robot'), 'trial ' + meta.trial + ', seed ' + meta.seed, meta.outcome].join(' · '));
  const notes = [meta.frames.note, meta.links && meta.links.note, meta.messages.note].filter(Boolean);
  for (const note of notes) byId('notes').append(make('li', note));
  byId('notes').hidden = notes.length === 0;
  setText(byId('foot'), 'desim ' + meta.desim + ', digest ' + meta.digest + '. Control period ' + meta.control_period_s + ' s, a frame every ' + meta.frames.every_s + ' s.');
}

let before = 0;
function loop(clock) {
  requestAnimationFrame(loop);
  if (now.playing) {
    // A page that was out of sight does not leap when it comes back.
    now.t = Math.min(duration, now.t + Math.min(0.1, (clock - before) / 1000) * now.speed);
    if (now.t >= duration) pause();
    noteFragment(false);
    view.dirty = true;
  }
  before = clock;
  if (!view.dirty) return;
  view.dirty = false;
  draw();
  const scrub = byId('scrub');
  if (Math.abs(scrub.value - now.t) > duration / 5000 || !now.playing) scrub.value = now.t;
  setText(byId('clock'), seconds(now.t) + ' of ' + Number(duration.toFixed(2)) + ' s, frame ' + grouped.format(now.frame));
  scrub.setAttribute('aria-valuetext', seconds(now.t));
  moveCursors();
  showSide(clock, !now.playing);
}

async function start() {
  describe();
  await unpack();
  prepareFrames();
  prepareRoles();
  prepareMessages();
  buildSide();
  buildEvents();
  buildCharts();
  listen();
  eventsFilter();
  layOut();
  drawStrip();
  drawCharts();
  const placed = readFragment();
  draw();
  showSide(0, true);
  showPlaying();
  requestAnimationFrame(loop);
  if (!placed && !stillness.matches) play();
}

window.desimReplay = {
  meta,
  seek: t => seek(t),
  time: () => now.t,
  positions: t => {
    const x = new Float64Array(robots);
    const y = new Float64Array(robots);
    placeRobots(clamp(t, 0, duration), x, y);
    const pairs = new Float64Array(robots * 2);
    for (let robot = 0; robot < robots; robot++) { pairs[robot * 2] = x[robot]; pairs[robot * 2 + 1] = y[robot]; }
    return pairs;
  },
  follow, play, pause,
  playing: () => now.playing,
  drawn: () => now.drawn,
  links: () => linksDrawn,
  roleCounts: () => Object.fromEntries(meta.roles.map((role, i) => [role, roles.counts[i]])),
  selectedEvent: () => (now.event >= 0 ? meta.events[now.event] : null),
  ready: start().catch(error => {
    const trouble = byId('trouble');
    trouble.hidden = false;
    setText(trouble, 'This replay cannot be shown. ' + error.message);
    throw error;
  }),
};

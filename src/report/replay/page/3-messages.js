// Messages near the moment that is shown, and what became of their copies.

const FADE = 0.3; // seconds of simulated time for which a message stays in the picture
const AGES = 4; // steps of fading: each is one path, so that thousands of lines cost few calls
const MOST_LINES = 6000; // above this, only every k-th line is drawn, and the caption says so
const DELIVERED = 0;
const UNDER_WAY = 255;

const stillness = matchMedia('(prefers-reduced-motion: reduce)');
const fateCount = meta.causes.length + 1;
const fateColours = [ink, ...meta.cause_colours, '#999999'];
const fateNames = ['delivered', ...meta.causes.map(words), 'under way'];
const underWay = fateCount; // the last row of the tables above

const near = {
  rings: 0, lines: 0, stride: 1, longest: FADE,
  sender: new Uint32Array(1024), age: new Uint8Array(1024), nextRing: new Int32Array(1024),
  from: new Uint32Array(MOST_LINES), to: new Uint32Array(MOST_LINES), nextLine: new Int32Array(MOST_LINES),
  ringHead: new Int32Array(meta.topics.length * AGES), lineHead: new Int32Array((fateCount + 1) * AGES),
  fates: new Float64Array(fateCount + 1), perTopic: new Float64Array(meta.topics.length),
};
const topicShown = meta.topics.map(() => true);
const hasMessages = meta.messages.count > 0;
const hasCopies = meta.messages.copies > 0;

function prepareMessages() {
  const { msg_t, msg_first, copy_t } = columns;
  if (!hasCopies) return;
  // A copy is drawn when it arrives, which may be long after it was handed to the radio: the window reaches that far back.
  let longest = 0;
  for (let message = 0; message < msg_t.length; message++) {
    for (let copy = msg_first[message]; copy < msg_first[message + 1]; copy++) {
      const delay = copy_t[copy] - msg_t[message];
      if (delay > longest) longest = delay;
    }
  }
  near.longest = FADE + Math.min(longest, 2);
}

/** Lines are too quick for the eye at higher speeds, and rings flash: what is drawn depends on the speed. */
function messageDetail() {
  if (!hasMessages || !now.showMessages) return 'none';
  if (now.playing && stillness.matches) return 'none';
  if (!hasCopies || (now.playing && now.speed > 1)) return 'rings';
  return 'lines';
}

function roomForRings() {
  for (const name of ['sender', 'age', 'nextRing']) {
    const larger = new near[name].constructor(near[name].length * 2);
    larger.set(near[name]);
    near[name] = larger;
  }
}

const fateOf = (copy, until) => {
  const fate = columns.copy_fate[copy];
  if (fate === UNDER_WAY || !(columns.copy_t[copy] <= until)) return underWay;
  return Math.min(fate, fateCount - 1);
};

/** Collects the messages of the window into lists by colour and age. Counts first, so that the lines can be thinned evenly. */
function collectMessages(t) {
  const { msg_t, msg_sender, msg_topic, msg_first, copy_t, copy_receiver } = columns;
  const until = slack(t);
  near.rings = near.lines = 0;
  near.fates.fill(0);
  near.perTopic.fill(0);
  near.ringHead.fill(-1);
  near.lineHead.fill(-1);
  const last = countUntil(msg_t, until);
  const first = countUntil(msg_t, t - near.longest, last);
  let copies = 0;
  for (let message = first; message < last; message++) {
    const topic = msg_topic[message];
    const age = until - msg_t[message];
    if (age < FADE) {
      near.perTopic[topic]++;
      if (topicShown[topic] && roles.shown[roles.value[msg_sender[message]]]) {
        if (near.rings === near.sender.length) roomForRings();
        const ring = near.rings++;
        const key = topic * AGES + Math.floor(age / FADE * AGES);
        near.sender[ring] = msg_sender[message];
        near.age[ring] = age / FADE * 255;
        near.nextRing[ring] = near.ringHead[key];
        near.ringHead[key] = ring;
      }
    }
    if (!hasCopies || !topicShown[topic]) continue;
    for (let copy = msg_first[message]; copy < msg_first[message + 1]; copy++) {
      const fate = fateOf(copy, until);
      if (fate !== underWay && until - copy_t[copy] >= FADE) continue;
      near.fates[fate]++;
      copies++;
    }
  }
  if (messageDetail() !== 'lines') return;
  near.stride = Math.ceil(copies / MOST_LINES);
  let passed = 0;
  for (let message = first; message < last; message++) {
    if (!topicShown[msg_topic[message]]) continue;
    for (let copy = msg_first[message]; copy < msg_first[message + 1]; copy++) {
      const fate = fateOf(copy, until);
      const age = fate === underWay ? 0 : until - copy_t[copy];
      if (age >= FADE || passed++ % near.stride !== 0) continue;
      const receiver = copy_receiver[copy];
      if (receiver >= robots || near.lines === MOST_LINES) continue;
      const key = fate * AGES + Math.floor(Math.max(0, age) / FADE * AGES);
      const line = near.lines++;
      near.from[line] = msg_sender[message];
      near.to[line] = receiver;
      near.nextLine[line] = near.lineHead[key];
      near.lineHead[key] = line;
    }
  }
}

/** What became of the messages in the window, in words. */
function messageCaption() {
  if (!hasMessages) return '';
  if (!now.showMessages) return 'Messages are not drawn.';
  if (now.playing && stillness.matches) return 'Messages are drawn while the run is paused, because this device asks for less motion.';
  let sum = 0;
  for (let topic = 0; topic < topicShown.length; topic++) if (topicShown[topic]) sum += near.perTopic[topic];
  const parts = ['Last ' + FADE + ' s: ' + count(sum, 'message')];
  if (!hasCopies) parts.push('. What became of them is not stored in this page.');
  else {
    const fates = fateNames.map((fate, i) => (near.fates[i] > 0 ? grouped.format(near.fates[i]) + ' ' + fate : '')).filter(Boolean);
    parts.push(fates.length ? '; copies: ' + fates.join(', ') + '.' : '; no copies.');
    if (messageDetail() === 'rings') parts.push(' Lines to receivers are drawn at 1× or slower.');
    else if (near.stride > 1) parts.push(' One line in ' + near.stride + ' is drawn.');
  }
  return parts.join('');
}

/** Messages to and from the followed robot: indices in order of time, found once when it is chosen. */
const own = { robot: -1, sent: new Uint32Array(0), sentAt: new Float32Array(0), received: new Uint32Array(0), receivedIn: new Uint32Array(0), receivedAt: new Float32Array(0) };

function findOwn(robot) {
  if (own.robot === robot) return;
  own.robot = robot;
  const { msg_sender, msg_first, copy_receiver, copy_t } = columns;
  const sent = [];
  const received = [];
  for (let message = 0; message < msg_sender.length; message++) {
    if (msg_sender[message] === robot) sent.push(message);
    if (!hasCopies) continue;
    for (let copy = msg_first[message]; copy < msg_first[message + 1]; copy++) {
      if (copy_receiver[copy] === robot) received.push([copy, message]);
    }
  }
  received.sort((a, b) => copy_t[a[0]] - copy_t[b[0]]);
  own.sent = Uint32Array.from(sent);
  own.sentAt = Float32Array.from(sent, message => columns.msg_t[message]);
  own.received = Uint32Array.from(received, pair => pair[0]);
  own.receivedIn = Uint32Array.from(received, pair => pair[1]);
  own.receivedAt = Float32Array.from(received, pair => copy_t[pair[0]]);
}

/** The last few messages of the followed robot before a time, newest first, as rows of time and words. */
function lastMessages(t, most) {
  const { msg_t, msg_topic, msg_sender, msg_first, msg_bytes, copy_fate } = columns;
  const until = slack(t);
  const rows = [];
  const sent = countUntil(own.sentAt, until);
  for (let i = sent - 1; i >= Math.max(0, sent - most); i--) {
    const message = own.sent[i];
    const fates = new Map();
    if (hasCopies) {
      for (let copy = msg_first[message]; copy < msg_first[message + 1]; copy++) {
        const fate = fateNames[fateOf(copy, until)];
        fates.set(fate, (fates.get(fate) || 0) + 1);
      }
    }
    const became = [...fates].map(([fate, number]) => number + ' ' + fate).join(', ');
    rows.push([msg_t[message], 'sent ' + words(meta.topics[msg_topic[message]]) + ', ' + msg_bytes[message] + ' B' + (became ? ': ' + became : '')]);
  }
  const heard = countUntil(own.receivedAt, until);
  for (let i = heard - 1; i >= Math.max(0, heard - most); i--) {
    const message = own.receivedIn[i];
    const fate = copy_fate[own.received[i]];
    const verb = fate === DELIVERED ? 'heard ' : 'missed ';
    const why = fate === DELIVERED ? '' : ' (' + fateNames[fate === UNDER_WAY ? underWay : Math.min(fate, fateCount - 1)] + ')';
    rows.push([own.receivedAt[i], verb + words(meta.topics[msg_topic[message]]) + ' of ' + msg_sender[message] + why]);
  }
  return rows.sort((a, b) => b[0] - a[0]).slice(0, most);
}

/** Whom the followed robot heard in the last seconds, as [robot, messages], most heard first. */
function heardLately(t, window) {
  const until = slack(t);
  const counts = new Map();
  for (let i = countUntil(own.receivedAt, until) - 1; i >= 0 && own.receivedAt[i] > t - window; i--) {
    if (columns.copy_fate[own.received[i]] !== DELIVERED) continue;
    const sender = columns.msg_sender[own.receivedIn[i]];
    counts.set(sender, (counts.get(sender) || 0) + 1);
  }
  return [...counts].sort((a, b) => b[1] - a[1] || a[0] - b[0]);
}

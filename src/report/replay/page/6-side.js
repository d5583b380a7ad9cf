// Beside the picture: roles with counts, topics, fates, and the followed robot.

const roleCounts = [];
const topicCounts = [];

/** A box to tick with a colour, a name and a count. */
function choice(list, colour, name, ring, onChange) {
  const item = make('li');
  const holder = make('label');
  const box = make('input');
  box.type = 'checkbox';
  box.checked = true;
  box.addEventListener('change', () => onChange(box.checked));
  const swatch = make('span', undefined, ring ? 'swatch ring' : 'swatch');
  swatch.style.setProperty('--colour', colour);
  const number = make('span', '', 'number');
  holder.append(box, swatch, make('span', words(name), 'name'), number);
  item.append(holder);
  list.append(item);
  return number;
}

/** A small drawing of a sign of the picture, by the same rules as the picture. */
function sign(list, name, paint) {
  const item = make('li');
  const canvas = make('canvas');
  canvas.width = canvas.height = 40;
  canvas.setAttribute('aria-hidden', 'true');
  const brush = canvas.getContext('2d');
  brush.scale(2, 2);
  brush.strokeStyle = ink;
  brush.fillStyle = '#b5b5b5';
  brush.lineWidth = 1.6;
  brush.beginPath();
  paint(brush);
  brush.stroke();
  item.append(canvas, make('span', name));
  list.append(item);
}

function buildSide() {
  meta.roles.forEach((role, i) => roleCounts.push(choice(byId('roles'), meta.role_colours[i], role, false, on => {
    roles.shown[i] = on;
    redraw();
  })));
  const signs = byId('signs');
  const body = brush => { brush.arc(10, 10, 4, 0, TURN); brush.fill(); brush.beginPath(); };
  if (meta.faults.length) sign(signs, 'failed', brush => { body(brush); brush.moveTo(3, 3); brush.lineTo(17, 17); brush.moveTo(3, 17); brush.lineTo(17, 3); });
  if (suspected.t.length) sign(signs, 'suspected', brush => { body(brush); brush.arc(10, 10, 7.5, 0.7, TURN - 0.7); });
  sign(signs, 'followed', brush => { body(brush); brush.lineWidth = 3; brush.arc(10, 10, 8, 0, TURN); });
  if (meta.targets.length) sign(signs, 'target', brush => { brush.moveTo(10, 2); brush.lineTo(18, 10); brush.lineTo(10, 18); brush.lineTo(2, 10); brush.closePath(); });
  if (relies.size) sign(signs, 'relies on', brush => { brush.strokeStyle = '#f0d9a0'; brush.lineWidth = 7; brush.moveTo(1, 10); brush.lineTo(19, 10); });
  if (hasMessages) {
    byId('topic-part').hidden = false;
    meta.topics.forEach((topic, i) => topicCounts.push(choice(byId('topics'), meta.topic_colours[i], topic, true, on => {
      topicShown[i] = on;
      redraw();
    })));
    if (hasCopies) buildFates();
  }
  if (!linksKnown) byId('show-links').parentElement.hidden = true;
  if (!hasMessages) byId('show-messages').parentElement.hidden = byId('caption').hidden = true;
  byId('robot-number').max = robots - 1;
  byId('robot-number').addEventListener('change', event => {
    const chosen = Number(event.target.value);
    follow(event.target.value !== '' && Number.isInteger(chosen) ? clamp(chosen, 0, robots - 1) : -1);
  });
  byId('unfollow').addEventListener('click', () => follow(-1));
  byId('centre').addEventListener('change', event => setCentred(event.target.checked));
  byId('robot').addEventListener('click', event => {
    const chosen = event.target.dataset.robot;
    if (chosen !== undefined) follow(Number(chosen));
  });
}

/** The lines of the picture by fate, for the fates that this run has. */
function buildFates() {
  const met = new Uint8Array(256);
  for (let copy = 0; copy < columns.copy_fate.length; copy++) met[columns.copy_fate[copy]] = 1;
  fateNames.forEach((fate, i) => {
    if (!met[i === underWay ? UNDER_WAY : i]) return;
    const item = make('li');
    const stroke = make('span', undefined, 'stroke');
    stroke.style.borderTop = '2px ' + (i === DELIVERED ? 'solid ' : i === underWay ? 'dotted ' : 'dashed ') + fateColours[i];
    item.append(stroke, make('span', fate));
    byId('fates').append(item);
  });
}

function setCentred(on) {
  now.keepCentred = on && now.followed >= 0;
  byId('centre').checked = now.keepCentred;
  if (now.keepCentred && view.fitted) zoom(3, view.wide / 2, view.high / 2);
  redraw();
}

/** Follows a robot, or none with -1. */
function follow(robot) {
  now.followed = Number.isInteger(robot) && robot >= 0 && robot < robots ? robot : -1;
  const nobody = now.followed < 0;
  byId('robot-number').value = nobody ? '' : now.followed;
  byId('unfollow').hidden = byId('centre-label').hidden = nobody;
  if (nobody) setCentred(false); else findOwn(now.followed);
  side.shown = '';
  eventsFilter();
  noteFragment(true);
  redraw();
}

const side = { shown: '', next: 0 };

function robotLink(robot, words) {
  const button = make('button', words === undefined ? String(robot) : words, 'link');
  button.dataset.robot = robot;
  button.setAttribute('aria-label', 'Follow robot ' + robot);
  return button;
}

function showRobot() {
  const panel = byId('robot');
  const robot = now.followed;
  if (robot < 0) {
    if (side.shown !== 'nobody') panel.replaceChildren(make('p', 'Click a robot in the picture, or type its number.', 'fine'));
    side.shown = 'nobody';
    return;
  }
  const rows = [];
  const state = [words(meta.roles[roles.value[robot]] ?? '')];
  if (failed.value[robot] > 0) state.push('failed');
  if (suspected.value[robot] > 0) state.push('suspected by ' + grouped.format(suspected.value[robot]));
  rows.push(['Role', state.join(', ')]);
  rows.push(['Place', now.worldX[robot].toFixed(2) + ', ' + now.worldY[robot].toFixed(2) + ' m']);
  if (linksKnown) {
    let degree = 0;
    for (let i = 0; i < links.length; i++) if (links.a[i] === robot || links.b[i] === robot) degree++;
    rows.push(['Links', grouped.format(degree)]);
  }
  if (relies.has(robot)) rows.push(['Relies on', reliedOn(relies.get(robot), now.t).join(', ') || 'nobody']);
  const faults = meta.faults.filter(fault => fault.robot === robot);
  if (faults.length) {
    rows.push(['Faults', faults.slice(0, 6).map(fault => words(fault.what) + ' ' + seconds(fault.from) + (fault.to === null ? ' to the end' : ' to ' + seconds(fault.to))).join('; ')]);
  }
  const heard = hasCopies ? heardLately(now.t, 3) : [];
  const last = hasMessages ? lastMessages(now.t, 8) : [];
  const key = JSON.stringify([robot, rows, heard, last]);
  if (key === side.shown) return;
  side.shown = key;
  // Whoever has put the keyboard on a robot in the list keeps it there.
  const focused = panel.contains(document.activeElement) ? document.activeElement.dataset.robot : undefined;
  const list = make('dl');
  for (const [name, value] of rows) list.append(make('dt', name), make('dd', value));
  if (hasCopies) {
    const value = make('dd');
    if (heard.length === 0) value.append('nobody in the last 3 s');
    heard.slice(0, 16).forEach(([sender, number], i) => {
      const pair = make('span', undefined, 'together');
      pair.append(robotLink(sender), make('span', '×' + number, 'fine'));
      value.append(i ? ' ' : '', pair);
    });
    if (heard.length > 16) value.append(' and ' + (heard.length - 16) + ' more');
    list.append(make('dt', 'Hears'), value);
  }
  panel.replaceChildren(list);
  if (last.length) {
    const table = make('table');
    table.append(make('caption', 'Last messages'));
    for (const [t, what] of last) {
      const row = make('tr');
      row.append(make('td', t.toFixed(2)), make('td', what));
      table.append(row);
    }
    panel.append(table);
  }
  if (focused !== undefined) panel.querySelector('[data-robot="' + Number(focused) + '"]')?.focus();
}

/** Brings the words beside the picture up to date, a few times a second: faster cannot be read. */
function showSide(clock, force) {
  if (!force && clock < side.next) return;
  side.next = clock + 150;
  roleCounts.forEach((element, i) => setText(element, grouped.format(roles.counts[i])));
  topicCounts.forEach((element, i) => setText(element, now.showMessages ? grouped.format(near.perTopic[i]) : ''));
  setText(byId('caption'), messageCaption());
  setText(byId('link-count'), linksKnown && now.showLinks ? grouped.format(linksDrawn) : '');
  showRobot();
  showEvents();
}

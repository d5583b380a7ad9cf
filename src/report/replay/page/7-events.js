// The list of events. There may be a hundred thousand, so only the rows in sight exist.

const ROW = 26;
const KINDS = { fault: '×', recovery: '+', suspicion: '?', trust: '=', role: '→', done: '!', note: '·' };
const list = { shown: new Int32Array(0), rows: [], current: -1, busyUntil: 0, off: new Set(), onlyRobot: false, times: Float64Array.from(meta.events, event => event.t) };

function buildEvents() {
  const holder = byId('kinds');
  const counts = new Map();
  for (const event of meta.events) counts.set(event.kind, (counts.get(event.kind) || 0) + 1);
  const tick = (name, checked, onChange) => {
    const label = make('label');
    const box = make('input');
    box.type = 'checkbox';
    box.checked = checked;
    box.addEventListener('change', () => onChange(box.checked));
    label.append(box, ' ' + name);
    holder.append(label);
    return label;
  };
  for (const [kind, number] of counts) {
    tick((KINDS[kind] || '·') + ' ' + kind + ' ' + grouped.format(number), true, on => {
      if (on) list.off.delete(kind); else list.off.add(kind);
      eventsFilter();
    });
  }
  list.onlyLabel = tick('followed robot only', false, on => { list.onlyRobot = on; eventsFilter(); });
  const box = byId('events');
  byId('happenings').hidden = meta.events.length === 0;
  box.addEventListener('scroll', drawRows);
  for (const kind of ['wheel', 'pointerdown', 'touchmove', 'keydown']) {
    box.addEventListener(kind, () => { list.busyUntil = performance.now() + 5000; }, { passive: true });
  }
  box.addEventListener('click', event => {
    const row = event.target.closest('.event');
    if (row) choose(Number(row.dataset.event), true);
  });
  box.addEventListener('keydown', event => {
    const by = { ArrowDown: 1, ArrowUp: -1, PageDown: 10, PageUp: -10 }[event.key];
    if (by === undefined || list.shown.length === 0) return;
    event.preventDefault();
    const at = now.event >= 0 ? list.shown.indexOf(now.event) : countShownUntil(now.t) - 1;
    choose(list.shown[clamp(at + by, 0, list.shown.length - 1)], true);
  });
}

function eventsFilter() {
  const only = list.onlyRobot && now.followed >= 0;
  list.onlyLabel.hidden = now.followed < 0;
  const kept = [];
  meta.events.forEach((event, i) => {
    if (list.off.has(event.kind)) return;
    if (only && event.robot !== now.followed && event.by !== now.followed) return;
    kept.push(i);
  });
  list.shown = Int32Array.from(kept);
  list.current = -2;
  byId('space').style.height = kept.length * ROW + 'px';
  setText(byId('events-title'), 'Events' + (kept.length < meta.events.length ? ': ' + grouped.format(kept.length) + ' of ' + grouped.format(meta.events.length) : ''));
  showEvents();
  drawRows();
}

/** How many of the listed events are at or before a time. */
function countShownUntil(t) {
  let low = 0;
  let high = list.shown.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list.times[list.shown[middle]] <= t) low = middle + 1; else high = middle;
  }
  return low;
}

function drawRows() {
  const box = byId('events');
  const first = Math.max(0, Math.floor(box.scrollTop / ROW) - 2);
  const wanted = Math.min(list.shown.length - first, Math.ceil(box.clientHeight / ROW) + 4);
  while (list.rows.length < wanted) {
    const row = make('div', undefined, 'event');
    row.setAttribute('role', 'option');
    row.id = 'event-' + list.rows.length;
    row.append(make('span', '', 'when'), make('span', '', 'kind'), make('span', '', 'what'));
    byId('space').append(row);
    list.rows.push(row);
  }
  let active = '';
  list.rows.forEach((row, i) => {
    row.hidden = i >= wanted;
    if (row.hidden) return;
    const place = first + i;
    const index = list.shown[place];
    const event = meta.events[index];
    row.dataset.event = index;
    row.style.transform = 'translateY(' + place * ROW + 'px)';
    setText(row.children[0], event.t.toFixed(1));
    setText(row.children[1], KINDS[event.kind] || '·');
    setText(row.children[2], event.title);
    row.title = event.kind + ': ' + event.title;
    row.classList.toggle('past', place < list.current);
    row.classList.toggle('current', place === list.current);
    row.setAttribute('aria-selected', String(index === now.event));
    row.setAttribute('aria-posinset', place + 1);
    row.setAttribute('aria-setsize', list.shown.length);
    if (index === now.event) active = row.id;
  });
  byId('events').setAttribute('aria-activedescendant', active);
}

/** Marks the last event before the moment, and keeps it in sight unless the person is busy in the list. */
function showEvents() {
  const current = countShownUntil(slack(now.t)) - 1;
  if (current === list.current) return;
  list.current = current;
  if (performance.now() > list.busyUntil) reveal(Math.max(0, current), 0.6);
  drawRows();
}

function reveal(place, part) {
  const box = byId('events');
  const top = place * ROW;
  if (top < box.scrollTop || top + ROW > box.scrollTop + box.clientHeight) box.scrollTop = Math.max(0, top - box.clientHeight * part);
}

/** Chooses an event: its details are shown, and the run stands at its time. */
function choose(index, jump) {
  now.event = index;
  const event = meta.events[index];
  showDetail(event);
  if (jump) {
    pause();
    seek(event.t);
    list.busyUntil = performance.now() + 5000;
  }
  if (event.robot !== null && event.robot !== undefined && now.followed !== event.robot) follow(event.robot);
  const place = list.shown.indexOf(index);
  if (place >= 0) reveal(place, 0.3);
  drawRows();
}

function showDetail(event) {
  const panel = byId('detail');
  panel.replaceChildren(make('h3', seconds(event.t) + ': ' + event.title));
  const more = [];
  if (event.until !== null && event.until !== undefined) more.push('until ' + seconds(event.until));
  const about = [...more, ...(event.detail || [])];
  const points = make('ul');
  for (const words of about) {
    if (!words.startsWith('desim ')) { points.append(make('li', words)); continue; }
    const row = make('div', undefined, 'command');
    const button = make('button', 'Copy');
    button.setAttribute('aria-label', 'Copy the command');
    button.addEventListener('click', async () => setText(button, (await copy(words)) ? 'Copied' : 'Select it'));
    row.append(make('code', words), button);
    panel.append(row);
  }
  if (points.children.length) panel.querySelector('h3').after(points);
}

async function copy(words) {
  try {
    await navigator.clipboard.writeText(words);
    return true;
  } catch {
    // A page from a file may have no clipboard: the old way still works there.
    const field = make('textarea');
    field.value = words;
    document.body.append(field);
    field.select();
    const done = document.execCommand('copy');
    field.remove();
    return done;
  }
}

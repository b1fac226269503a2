// The table of pairs: columns that sort, a search and four filters. Filters that would have nothing to choose are not shown.
const COLUMNS = [
  { key: 'link1', label: 'Link 1', text: true, name: true },
  { key: 'link2', label: 'Link 2', text: true, name: true },
  { key: 'distance', label: 'STP-BV mm', title: 'Distance of the two smooth volumes; negative: they overlap' },
  { key: 'hull_distance', label: 'Hulls mm', title: 'Distance of the convex hulls; overlap: how deep is not measured' },
  { key: 'mesh_distance', label: 'Meshes mm', title: 'Distance of the triangle meshes, 0 where they meet; –: not measured, as the volumes are far apart' },
  { key: 'cover', label: 'Cover mm', title: 'How much closer the volumes are than their hulls, along the normal' },
  { key: 'cause', label: 'Cause', title: 'What meets, or is within the margin: the meshes, only their hulls, or only the covers around them', text: true },
  { key: 'reason', label: 'Over all postures', title: 'What the search for collisions says of all postures, not only of this one', text: true },
  { key: 'srdf_reason', label: 'SRDF', title: 'What the SRDF says', text: true }
];
// What a narrow table leaves out, in this order; a chosen pair's details show all of it.
const DROPPED = ['srdf_reason', 'cover', 'hull_distance', 'reason', 'mesh_distance', 'cause'];

const COVERS_ONLY = ['hull only', 'margin only'];  // causes that the meshes have no part in

const PADDING = 12;  // of a cell, both sides (pixels)
const FILTERS = ['search', 'link', 'state', 'reason', 'cause'];
const LEAST_NAME = 'nnnnnnnnnn';  // so much of a name is shown at least

const STATES = {
  checked: ['checked', p => p.checked],
  colliding: ['', p => p.checked && p.colliding],  // named as the report does
  undecided: ['not decided', p => p.verdict === 'undecided'],
  skipped: ['not checked', p => !p.checked],
  contradicts: ['contradicts the SRDF', p => p.contradicts_srdf],
  kinked: ['gradient may jump', p => p.checked && !p.continuous]
};

// What is said of a pair, and how it looks.
function stateOf(pair, report) {
  if (!pair.checked) return ['not checked', ''];
  return pair.colliding ? [hitWord(report), 'hit'] : pair.verdict === 'undecided' ? ['not decided', 'warn'] : ['clear', ''];
}

// "always" stands for at least 95 % of the samples.
const reasonWord = reason => reason === 'always' ? 'nearly always' : reason;

function cellText({ key, text }, pair) {
  if (key === 'reason') return reasonWord(pair.reason);
  if (key === 'hull_distance' && pair[key] === null) return 'overlap';
  return text ? pair[key] : mm(pair[key]);
}

// What a column is sorted by: hulls that overlap are nearest.
const sortValue = (pair, key) => key === 'hull_distance' && pair[key] === null ? -Infinity : pair[key];

class PairTable {
  constructor(report, onSelect) {
    const pairs = this.pairs = report.pairs;
    STATES.colliding[0] = hitWord(report);
    this.onSelect = onSelect;
    this.links = [...new Set([...report.bodies.map(body => body.owner), ...pairs.flatMap(p => [p.link1, p.link2])])];  // also those of no pair
    this.shorten = shortener(this.links);
    this.selected = -1;
    this.sort = { key: null, sign: 1 };
    const known = { mesh_distance: 1, cause: 1, srdf_reason: 1 };
    this.columns = COLUMNS.filter(c => !known[c.key] || pairs.some(p => p[c.key] !== null && p[c.key] !== '')).map(c =>
      c.key === 'reason' && !report.sampled ? { ...c, label: 'Kind', title: 'With another link of the robot, or with an obstacle' } : c);
    this.makeHead();
    this.makeFilters();
    this.rows = pairs.map((pair, i) => this.makeRow(pair, i));
    byId('tablebox').onkeydown = e => this.step(e);
    new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(byId('tablebox'));
    this.fill();
  }

  // As wide as the longest content of a column needs, in pixels, names up to a limit. A wider table shares out the rest.
  widthOf(column) {
    const most = 190, style = getComputedStyle(byId('table'));
    const pen = document.createElement('canvas').getContext('2d');
    const widest = (weight, texts) => {
      pen.font = `${weight} ${style.fontSize} ${style.fontFamily}`;
      return [...texts].reduce((width, text) => Math.max(width, pen.measureText(text).width), 0);
    };
    if (column.name) this.textWidth = text => widest('400', [text]);
    if (column.name) column.least = Math.ceil(widest('400', [LEAST_NAME])) + PADDING;
    const cells = new Set(this.pairs.map(p => cellText(column, p)));
    const width = Math.max(widest('600', column.label.split(' ')), widest(column.key === 'distance' ? '650' : '400', cells));
    return Math.min(most, PADDING + Math.ceil(width));
  }

  makeHead() {
    for (const column of this.columns) {
      const col = column.col = make('col');
      column.width = this.widthOf(column);
      document.querySelector('#table colgroup').append(col);
      const head = make('th', column.text ? '' : 'n', column.label);
      head.title = column.title || '';
      head.dataset.key = column.key;
      sortable(head, () => this.sortBy(column.key));
      column.head = head;
      document.querySelector('#table thead tr').append(head);
    }
  }

  // Where there is too little room, the words give way first, then whole columns, then the names down to their least width.
  fit() {
    const words = c => c.text && !c.name && c.key !== 'cause', room = byId('tablebox').clientWidth;
    const least = c => c.name ? Math.min(c.least, c.width) : words(c) ? Math.max(0.5 * c.width, Math.min(70, c.width)) : c.width;
    const total = (columns, width) => columns.reduce((sum, column) => sum + width(column), 0);
    let shown = this.columns;
    for (const key of DROPPED) if (total(shown, least) > room) shown = shown.filter(c => c.key !== key);
    const widths = new Map(shown.map(column => [column, column.width]));
    for (const gives of [words, c => c.name]) {
      const over = total(shown, c => widths.get(c)) - room, columns = shown.filter(gives), most = total(columns, c => c.width - least(c));
      if (over > 0 && most > 0) for (const c of columns) widths.set(c, Math.floor(c.width - Math.min(1, over / most) * (c.width - least(c))));
    }
    this.columns.forEach((column, k) => {
      const dropped = !widths.has(column);
      for (const part of [column.col, column.head, ...this.rows.map(row => row.children[k])]) part.hidden = dropped;
      if (dropped) return;
      column.col.style.width = `${widths.get(column)}px`;
      if (!column.name) return;
      const short = new Map();
      this.rows.forEach((row, i) => {
        const name = this.pairs[i][column.key];
        if (!short.has(name)) short.set(name, this.shorten(name, text => this.textWidth(text) <= widths.get(column) - PADDING));
        row.children[k].textContent = short.get(name);
      });
    });
  }

  makeRow(pair, i) {
    const row = make('tr', pair.checked ? pair.colliding ? 'hit' : pair.verdict === 'undecided' ? 'undecided' : '' : 'off');
    row.dataset.pair = i;
    for (const column of this.columns) {
      const { key, text } = column;
      const cell = make('td', text ? '' : key === 'distance' ? 'n d' : 'n', cellText(column, pair));
      if (text) cell.title = pair[key];
      if (key === 'link1' && pair.touches_first) cell.dataset.tag = 'first contact';
      if (key === 'cause' && pair.cause) cell.replaceChildren(make('b', `cause ${COVERS_ONLY.includes(pair.cause) ? '' : 'hit'}`, pair.cause));
      row.append(cell);
    }
    row.onclick = () => this.onSelect(i);
    return row;
  }

  makeFilters() {
    const choices = (id, label, values, nameOf = v => v) => {
      const select = byId(id);
      select.append(new Option(label, ''), ...values.map(v => new Option(nameOf(v), v)));
      select.hidden = values.length < 1;
      select.onchange = () => this.fill();
    };
    const values = key => [...new Set(this.pairs.map(p => p[key]).filter(v => v))].sort();
    choices('link', 'Any link', [...this.links].sort());
    choices('state', 'All pairs', Object.keys(STATES).filter(s => this.pairs.some(STATES[s][1])), state => STATES[state][0]);
    choices('reason', 'Any reason', values('reason'), reasonWord);
    choices('cause', 'Any cause', values('cause'));
    byId('search').oninput = () => this.fill();
    byId('clear').onclick = () => this.filter({});
  }

  // The filters as given, all others open.
  filter(values) {
    for (const id of FILTERS) byId(id).value = values[id] || '';
    this.fill();
  }

  // Every word of the search is part of one of the two names.
  passes(pair) {
    const words = byId('search').value.toLowerCase().split(/\s+/), names = `${pair.link1} ${pair.link2}`.toLowerCase();
    const { value: link } = byId('link'), { value: state } = byId('state');
    return words.every(word => names.includes(word)) && (!link || pair.link1 === link || pair.link2 === link) &&
      (!state || STATES[state][1](pair)) && ['reason', 'cause'].every(id => !byId(id).value || pair[id] === byId(id).value);
  }

  sortBy(key) {
    this.sort = { key, sign: this.sort.key === key ? -this.sort.sign : 1 };
    this.fill();
  }

  // Rows that pass the filters, in order.
  fill() {
    this.order = this.pairs.map((_, i) => i).filter(i => this.passes(this.pairs[i]));
    const { key, sign } = this.sort;
    if (key) this.order.sort((a, b) => compared(sortValue(this.pairs[a], key), sortValue(this.pairs[b], key), sign));
    document.querySelector('#table tbody').replaceChildren(...this.order.map(i => this.rows[i]));
    showOrder(document.querySelectorAll('#table th'), this.sort);
    const set = FILTERS.filter(id => {
      byId(id).classList.toggle('set', byId(id).value !== '');
      return byId(id).value !== '';
    });
    const all = counted(this.pairs.length, 'pair');
    byId('clear').hidden = !set.length;
    byId('count').textContent = set.length ? `${this.order.length} of ${all}` : all;
    byId('nothing').hidden = this.order.length > 0;
    byId('nothing').textContent = this.pairs.length ? 'No pair passes these filters.' : 'The report has no pairs.';
  }

  mark(i) {
    for (const [row, on] of [[this.rows[this.selected], false], [this.rows[i], true]]) {
      if (!row) continue;
      row.classList.toggle('sel', on);
      row.setAttribute('aria-selected', on);
    }
    this.selected = i;
  }

  // Into the table's box; the page stays where it is.
  reveal(i) {
    const box = byId('tablebox'), row = this.rows[i], head = document.querySelector('#table thead').offsetHeight;
    if (!row.isConnected) return;
    const top = row.getBoundingClientRect().top - box.getBoundingClientRect().top;
    if (top < head || top + row.offsetHeight > box.clientHeight) box.scrollTop += top - (box.clientHeight - row.offsetHeight) / 2;
  }

  // Up and down arrows walk through the rows.
  step(event) {
    const way = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    const next = this.order[Math.max(0, Math.min(this.order.length - 1, this.order.indexOf(this.selected) + way))];
    if (next === undefined) return;
    this.onSelect(next);
    this.rows[next].scrollIntoView({ block: 'nearest' });
  }
}

function causeTag(cause) {
  return make('span', `tag ${COVERS_ONLY.includes(cause) ? 'warn' : 'hit'}`, cause);
}

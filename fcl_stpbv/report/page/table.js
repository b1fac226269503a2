// The table of pairs: columns that sort, a search and four filters. Filters that would have nothing to choose are not shown.
const COLUMNS = [
  { key: 'link1', label: 'Link 1', text: true, name: true },
  { key: 'link2', label: 'Link 2', text: true, name: true },
  { key: 'distance', label: 'STP-BV mm', title: 'Distance of the two smooth volumes; negative: they overlap' },
  { key: 'hull_distance', label: 'Hulls mm', title: 'Distance of the convex hulls' },
  { key: 'mesh_distance', label: 'Meshes mm', title: 'Distance of the triangle meshes' },
  { key: 'cover', label: 'Cover mm', title: 'How much closer the volumes are than their hulls, along the normal' },
  { key: 'cause', label: 'Cause', title: 'What meets, or is within the margin: the meshes, only their hulls, or only the covers around them', text: true },
  { key: 'reason', label: 'Reason', title: 'What the search for collisions says', text: true },
  { key: 'srdf_reason', label: 'SRDF', title: 'What the SRDF says', text: true }
];

const COVERS_ONLY = ['hull only', 'margin only'];  // causes that the meshes have no part in

const PADDING = 12;  // of a cell, both sides (pixels)

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

function cellText({ key, text }, pair) {
  return text ? pair[key] : mm(pair[key]);
}

class PairTable {
  constructor(report, onSelect) {
    const pairs = this.pairs = report.pairs;
    STATES.colliding[0] = hitWord(report);
    this.onSelect = onSelect;
    this.shorten = shortener([...new Set(pairs.flatMap(p => [p.link1, p.link2]))]);
    this.selected = -1;
    this.sort = { key: null, sign: 1 };
    const known = { hull_distance: 1, mesh_distance: 1, cause: 1, srdf_reason: 1 };
    this.columns = COLUMNS.filter(c => !known[c.key] || pairs.some(p => p[c.key] !== null && p[c.key] !== ''));
    this.makeHead();
    this.makeFilters();
    this.rows = pairs.map((pair, i) => this.makeRow(pair, i));
    byId('tablebox').onkeydown = e => this.step(e);
    new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(byId('tablebox'));
    this.fill();
  }

  // As wide as the longest content of a column needs, in pixels, names up to a limit. A wider table shares out the rest, in a
  // narrower one names give way.
  widthOf(column) {
    const most = 190, style = getComputedStyle(byId('table'));
    const pen = document.createElement('canvas').getContext('2d');
    const widest = (weight, texts) => {
      pen.font = `${weight} ${style.fontSize} ${style.fontFamily}`;
      return [...texts].reduce((width, text) => Math.max(width, pen.measureText(text).width), 0);
    };
    if (column.name) this.textWidth = text => widest('400', [text]);
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
      head.tabIndex = 0;
      head.dataset.key = column.key;
      head.onclick = () => this.sortBy(column.key);
      head.onkeydown = e => { if (e.key === 'Enter') this.sortBy(column.key); };
      document.querySelector('#table thead tr').append(head);
    }
  }

  // Takes what is missing from the other words first, then from the names.
  fit() {
    let over = this.columns.reduce((sum, column) => sum + column.width, 0) - byId('tablebox').clientWidth;
    const widths = new Map(this.columns.map(column => [column, column.width]));
    for (const [least, shrink] of [[0.5, c => c.text && !c.name && c.key !== 'cause'], [0.4, c => c.name]]) {
      const columns = this.columns.filter(shrink), sum = columns.reduce((all, column) => all + column.width, 0);
      const share = Math.min(1, Math.max(least, 1 - over / sum));
      for (const column of columns) widths.set(column, Math.floor(share * column.width));
      over -= (1 - share) * sum;
    }
    this.columns.forEach((column, k) => {
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
      if (key === 'cause' && pair.cause) cell.replaceChildren(make('b', `cause ${COVERS_ONLY.includes(pair.cause) ? '' : 'hit'}`, pair.cause));
      row.append(cell);
    }
    row.onclick = () => this.onSelect(i);
    return row;
  }

  makeFilters() {
    const choices = (id, label, values, names = {}) => {
      const select = byId(id);
      select.append(new Option(label, ''), ...values.map(v => new Option(names[v] || v, v)));
      select.hidden = values.length < 1;
      select.onchange = () => this.fill();
    };
    const values = key => [...new Set(this.pairs.map(p => p[key]).filter(v => v))].sort();
    choices('link', 'Any link', [...new Set(this.pairs.flatMap(p => [p.link1, p.link2]))].sort());
    choices('state', 'All pairs', Object.keys(STATES).filter(s => this.pairs.some(STATES[s][1])),
      Object.fromEntries(Object.entries(STATES).map(([key, [name]]) => [key, name])));
    choices('reason', 'Any reason', values('reason'));
    choices('cause', 'Any cause', values('cause'));
    byId('search').oninput = () => this.fill();
    byId('clear').onclick = () => {
      for (const id of ['search', 'link', 'state', 'reason', 'cause']) byId(id).value = '';
      this.fill();
    };
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

  // Rows that pass the filters, in order. What is not known comes last either way.
  fill() {
    this.order = this.pairs.map((_, i) => i).filter(i => this.passes(this.pairs[i]));
    const { key, sign } = this.sort, missing = v => v === null || v === undefined || v === '';
    if (key) this.order.sort((a, b) => {
      const x = this.pairs[a][key], y = this.pairs[b][key];
      if (missing(x) || missing(y)) return missing(x) - missing(y);
      return sign * (typeof x === 'string' ? x.localeCompare(y) : x - y);
    });
    document.querySelector('#table tbody').replaceChildren(...this.order.map(i => this.rows[i]));
    for (const head of document.querySelectorAll('#table th')) {
      if (head.dataset.key === key) head.setAttribute('aria-sort', sign > 0 ? 'ascending' : 'descending');
      else head.removeAttribute('aria-sort');
    }
    const set = ['search', 'link', 'state', 'reason', 'cause'].filter(id => {
      byId(id).classList.toggle('set', byId(id).value !== '');
      return byId(id).value !== '';
    });
    const counted = this.pairs.length === 1 ? '1 pair' : `${this.pairs.length} pairs`;
    byId('clear').hidden = !set.length;
    byId('count').textContent = set.length ? `${this.order.length} of ${counted}` : counted;
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

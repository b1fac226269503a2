// The list of links: how far hulls and volumes exceed their meshes; and the links that are split into convex parts.
class LinkTable {
  constructor(report, onSelect) {
    const links = this.links = report.links;
    this.columns = [['name', 'Link'], ['volume_excess', 'Volume over mesh mm'], ['hull_excess', 'Hull over mesh mm'], ['over_cover_max', 'Volume over hull mm'],
      ['volume_ratio', 'Volume / mesh'], ['r', 'r mm'], ['R', 'R m'], ['vertices', 'Vertices']]
      .filter(([key]) => links.some(link => link[key] !== null && link[key] !== undefined));
    byId('links').hidden = this.columns.length < 2;
    this.sort = { key: null, sign: 1 };
    for (const [key, label] of this.columns) {
      const head = make('th', key === 'name' ? '' : 'n', label);
      head.dataset.key = key;
      sortable(head, () => {
        // Numbers begin with the largest, which matter most.
        this.sort = { key, sign: this.sort.key === key ? -this.sort.sign : key === 'name' ? 1 : -1 };
        this.fill();
      });
      document.querySelector('#linktable thead tr').append(head);
    }
    // A part is below what it is of, a further shape of a link below the first one.
    this.above = links.map((link, i) => {
      const above = link.part_of ? links.findIndex(other => other.name === link.part_of) : report.bodies.findIndex(body => body.link === report.bodies[i].link);
      return above === i ? -1 : above;
    });
    this.rows = links.map((link, i) => this.makeRow(link, this.above[i] < 0 ? '' : 'part', () => onSelect(report.bodies[i].owner)));
    this.fill();
    new ResizeObserver(() => requestAnimationFrame(() => this.fit())).observe(byId('linkbox'));
  }

  makeRow(link, look, onSelect) {
    const row = make('tr', look);
    for (const [key] of this.columns) row.append(make('td', key === 'name' ? '' : 'n', key === 'name' ? link.name : this.text(key, link[key])));
    row.cells[0].title = link.file ? `${link.name} (${link.file})` : link.name;
    row.onclick = onSelect;
    return row;
  }

  text(key, v) {
    if (v === null || v === undefined) return '–';
    return key === 'vertices' ? String(v) : key === 'R' || key === 'volume_ratio' ? fixed(v, 3) : mm(v);
  }

  // Without a choice, those whose volume exceeds their mesh most come first.
  fill() {
    const { key, sign } = this.sort, value = link => key ? link[key] : link.volume_excess ?? link.over_cover_max ?? -1, order = [];
    const add = above => {
      const some = this.links.map((_, i) => i).filter(i => this.above[i] === above);
      for (const i of some.sort((a, b) => compared(value(this.links[a]), value(this.links[b]), key ? sign : -1))) {
        order.push(i);
        add(i);
      }
    };
    add(-1);
    document.querySelector('#linktable tbody').replaceChildren(...order.map(i => this.rows[i]));
    showOrder(document.querySelectorAll('#linktable th'), this.sort);
  }

  fit() {
    const cell = this.rows.length && this.rows[0].cells[0], most = Math.max(96, Math.min(190, 0.3 * byId('linkbox').clientWidth));
    if (!cell) return;
    const short = fittedNames(this.links.map(link => link.name), cell, most - PADDING);
    this.rows.forEach((row, i) => { row.cells[0].textContent = short.get(this.links[i].name); });
  }
}

// With --parts: which links are split, for which pairs, and what that costs a controller.
function showParts(report) {
  const { rows } = report.summary, { links, pairs } = report;
  if (!rows) return;
  byId('parts').hidden = false;
  const listed = some => some.slice(0, 3).map(p => `${p.link1} – ${p.link2}`).join(', ') + (some.length > 3 ? ` and ${some.length - 3} more` : '');
  const lines = links.map((link, i) => ({ link, owner: report.bodies[i].owner })).filter(({ link }) => link.parts).map(({ link, owner }) => {
    const excess = Math.max(0, ...links.filter(part => part.part_of === link.name).map(part => part.excess_max));
    const own = pairs.filter(p => p.by_parts && (p.link1 === owner || (!p.obstacle && p.link2 === owner)));
    return `${link.name} in ${link.parts} parts, ${mm(excess, 3)} mm from the mesh at most${own.length ? `, for ${listed(own)}` : ''}`;
  });
  const left = pairs.filter(p => p.checked && p.colliding && p.cause === 'hull only');
  if (!lines.length && !left.length) lines.push('No link needs to be split.');
  const some = left.length === 1 ? 'the pair that collides by its hulls' : `the ${left.length} pairs that collide by their hulls`;
  if (left.length) lines.push(`No parts clear ${some} alone: ${listed(left)}`);
  byId('parts').querySelector('ul').replaceChildren(...lines.map(text => make('li', '', text)));
  const add = (name, ...values) => byId('partrows').tBodies[0].append(make('tr', '', '', make('td', '', name), ...values.map(text => make('td', 'n', text))));
  byId('partrows').hidden = !links.some(link => link.parts);
  add('whole bodies', String(rows.whole), fixed(rows.whole_us_per_tick, 1));
  add('parts', String(rows.parts), fixed(rows.parts_us_per_tick, 1));
  add(`parts below ${report.hand_over} m, whole bodies above; ${rows.hand_over_live} of the rows not constant`, String(rows.hand_over),
    fixed(rows.hand_over_us_per_tick, 1));
}

// The heat map: links against links, coloured by distance, with its legend.

// Near is dark and warm, far is cool.
const SCALE = [[0, [153, 36, 88]], [0.25, [226, 98, 72]], [0.5, [247, 173, 92]], [0.75, [222, 214, 160]], [1, [126, 172, 186]]];
const MOST_HIGH = 900;  // of the map, so that it is seen at a glance

function scaleColour(t) {
  const upper = Math.max(1, SCALE.findIndex(([at]) => t <= at)), [low, from] = SCALE[upper - 1], [high, to] = SCALE[upper];
  return `rgb(${from.map((c, i) => Math.round(c + (to[i] - c) * (t - low) / (high - low))).join(',')})`;
}

class HeatMap {
  constructor(report, onSelect) {
    // An obstacle may have the name of a link.
    const links = new Set(report.bodies.filter(body => !body.obstacle).map(body => body.owner));
    const label = (name, obstacle) => obstacle && links.has(name) ? `${name} (obstacle)` : name;
    this.ends = pair => [pair.link1, label(pair.link2, pair.obstacle)];
    const pairs = this.pairs = report.pairs, place = new Map(report.bodies.map((body, i) => [label(body.owner, body.obstacle), i]));
    this.selected = -1;
    this.canvas = byId('heat');
    this.names = [...new Set(pairs.flatMap(this.ends))].sort((a, b) => place.get(a) - place.get(b));
    this.shorten = shortener(this.names);
    const number = new Map(this.names.map((name, i) => [name, i]));
    this.at = new Map();
    pairs.forEach((p, i) => {
      const [a, b] = this.ends(p).map(name => number.get(name));
      this.at.set(a * this.names.length + b, i);
      this.at.set(b * this.names.length + a, i);
    });
    // The scale ends at a round number above most of the distances that matter.
    const apart = pairs.filter(p => p.checked && p.distance > 0).map(p => p.distance).sort((a, b) => a - b);
    const most = apart[Math.floor(0.6 * apart.length)] || 0.1;
    const power = 10 ** Math.floor(Math.log10(most));
    this.far = Number((([1, 2, 3, 5].find(v => v * power >= most * (1 - 1e-9)) || 10) * power).toPrecision(1));
    this.makeLegend(hitWord(report));
    new ResizeObserver(() => requestAnimationFrame(() => this.draw())).observe(byId('mapbox'));
    this.canvas.onclick = e => { const i = this.under(e); if (i !== undefined) onSelect(i); };
    this.canvas.onmousemove = e => this.tell(e);
    this.canvas.onmouseleave = () => { byId('tip').hidden = true; };
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
  }

  makeLegend(hit) {
    const swatch = colour => { const i = make('i'); i.style.background = colour; return i; };
    const bar = make('canvas');
    bar.width = 130;
    bar.height = 1;
    for (let x = 0; x < 130; ++x) {
      bar.getContext('2d').fillStyle = scaleColour(x / 129);
      bar.getContext('2d').fillRect(x, 0, 1, 1);
    }
    byId('legend').replaceChildren(make('span', '', '', swatch('var(--touch)'), hit),
      make('span', '', '', '0', bar, `${this.far < 10 ? `${brief(1e3 * this.far)} mm` : `${this.far} m`} and more apart`), make('span', '', '', swatch('var(--off)'), 'not checked'));
  }

  colour(pair) {
    if (!pair.checked) return this.style.getPropertyValue('--off');
    return pair.colliding ? this.style.getPropertyValue('--touch') : scaleColour(Math.max(0, Math.min(1, pair.distance / this.far)));
  }

  draw() {
    this.style = getComputedStyle(document.documentElement);
    const g = this.canvas.getContext('2d'), sharp = window.devicePixelRatio, count = Math.max(1, this.names.length);
    g.font = '600 11px system-ui, "DejaVu Sans", sans-serif';
    this.margin = Math.ceil(Math.min(count > 40 ? 110 : 150, Math.max(20, ...this.names.map(n => g.measureText(n).width)))) + 8;
    const room = Math.min(byId('mapbox').clientWidth, MOST_HIGH) - this.margin - 2;
    this.cell = Math.max(7, Math.min(24, Math.floor(room / count)));
    const size = this.margin + this.cell * count + 2;
    this.canvas.width = this.canvas.height = size * sharp;
    this.canvas.style.width = this.canvas.style.height = size + 'px';
    g.scale(sharp, sharp);
    const pair = this.pairs[this.selected], picked = pair ? this.ends(pair) : [];
    this.names.forEach((name, i) => {
      g.font = `${picked.includes(name) ? 600 : 400} ${Math.min(11, this.cell)}px system-ui, "DejaVu Sans", sans-serif`;
      g.fillStyle = this.style.getPropertyValue(name === picked[0] ? '--first' : name === picked[1] ? '--second' : '--soft');
      const short = this.shorten(name, text => g.measureText(text).width <= this.margin - 8);
      g.textAlign = 'right';
      g.fillText(short, this.margin - 5, this.margin + (i + 0.78) * this.cell);
      g.save();
      g.translate(this.margin + (i + 0.78) * this.cell, this.margin - 5);
      g.rotate(-Math.PI / 2);
      g.textAlign = 'left';
      g.fillText(short, 0, 0);
      g.restore();
    });
    for (const [k, i] of this.at) {
      const x = this.margin + (k % count) * this.cell, y = this.margin + Math.floor(k / count) * this.cell;
      g.fillStyle = this.colour(this.pairs[i]);
      g.fillRect(x, y, this.cell - 1, this.cell - 1);
      if (i !== this.selected) continue;
      g.strokeStyle = this.style.getPropertyValue('--ink');
      g.lineWidth = 2;
      g.strokeRect(x - 0.5, y - 0.5, this.cell, this.cell);
    }
  }

  under(event) {
    const [row, column] = [event.offsetY, event.offsetX].map(v => Math.floor((v - this.margin) / this.cell)), count = this.names.length;
    return row >= 0 && column >= 0 && row < count && column < count ? this.at.get(row * count + column) : undefined;
  }

  tell(event) {
    const i = this.under(event), tip = byId('tip');
    tip.hidden = i === undefined;
    if (tip.hidden) return;
    const p = this.pairs[i];
    tip.textContent = `${this.ends(p).join(' – ')}: ${mm(p.distance)} mm${p.checked ? '' : ', not checked'}`;
    tip.style.left = `${Math.max(0, Math.min(event.offsetX + 14, byId('mapbox').scrollLeft + byId('mapbox').clientWidth - tip.offsetWidth - 4))}px`;
    tip.style.top = `${event.offsetY + 16}px`;
  }

  mark(i) {
    this.selected = i;
    this.draw();
  }
}

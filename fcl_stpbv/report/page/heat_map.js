// The heat map: links against links, coloured by distance, with its legend.

// Near is dark and warm, far is cool.
const SCALE = [[0, [153, 36, 88]], [0.25, [226, 98, 72]], [0.5, [247, 173, 92]], [0.75, [222, 214, 160]], [1, [126, 172, 186]]];
const MOST_HIGH = 900;  // of the map, so that it is seen at a glance
const LEAST_CELL = 12;  // pixels: its labels can be read; a larger map scrolls

// The least of 1, 2, 3, 5 and 10 times a power of ten that most of the values are below.
function roundAbove(values, part) {
  const sorted = [...values].sort((a, b) => a - b), most = sorted[Math.floor(part * sorted.length)] || 0.1, power = 10 ** Math.floor(Math.log10(most));
  return Number((([1, 2, 3, 5].find(v => v * power >= most * (1 - 1e-9)) || 10) * power).toPrecision(1));
}

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
    // The scales end at a round number above most of the distances and depths that matter.
    const checked = pairs.filter(p => p.checked), { margin } = report.summary;
    this.depth = pair => margin - pair.distance;
    this.far = roundAbove(checked.filter(p => p.distance > 0).map(p => p.distance), 0.6);
    this.deep = roundAbove(checked.filter(p => p.colliding && this.depth(p) > 0).map(this.depth), 0.9);
    this.makeLegend(report);
    new ResizeObserver(() => requestAnimationFrame(() => this.draw())).observe(byId('mapbox'));
    this.canvas.onclick = e => { const i = this.under(e); if (i !== undefined) onSelect(i); };
    this.canvas.onkeydown = e => this.step(e, onSelect);
    this.canvas.onmousemove = e => this.tell(e);
    this.canvas.onmouseleave = () => { byId('tip').hidden = true; };
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.draw());
  }

  makeLegend(report) {
    const swatch = colour => { const i = make('i'); i.style.background = colour; return i; };
    const scale = (from, background, to) => {
      const bar = make('i', 'scale');
      bar.style.background = background;
      return make('span', '', '', from, bar, to);
    };
    const length = metres => metres < 10 ? `${brief(1e3 * metres)} mm` : `${metres} m`;
    const steps = SCALE.map(([at]) => `${scaleColour(at)} ${100 * at}%`), hit = hitWord(report);
    byId('legend').replaceChildren(
      report.pairs.some(p => p.checked && p.colliding)
        ? scale(`${hit}: 0`, 'linear-gradient(90deg, var(--touch), var(--deep))', `${length(this.deep)} and deeper`)
        : make('span', '', '', swatch('var(--touch)'), hit),
      scale('0', `linear-gradient(90deg, ${steps})`, `${length(this.far)} and more apart`),
      make('span', '', '', swatch('var(--off)'), 'not checked'));
  }

  colour(pair) {
    if (!pair.checked) return this.style.getPropertyValue('--off');
    if (!pair.colliding) return scaleColour(Math.max(0, Math.min(1, pair.distance / this.far)));
    const share = Math.max(0, Math.min(1, this.depth(pair) / this.deep));
    const [from, to] = ['--touch', '--deep'].map(name => this.style.getPropertyValue(name).match(/[0-9a-f]{2}/gi).map(c => parseInt(c, 16)));
    return `rgb(${from.map((c, k) => Math.round(c + share * (to[k] - c))).join(',')})`;
  }

  draw() {
    this.style = getComputedStyle(document.documentElement);
    const g = this.canvas.getContext('2d'), sharp = window.devicePixelRatio, count = Math.max(1, this.names.length);
    g.font = '600 12px system-ui, "DejaVu Sans", sans-serif';
    this.margin = Math.ceil(Math.min(count > 40 || byId('mapbox').clientWidth < 420 ? 110 : 150, Math.max(20, ...this.names.map(n => g.measureText(n).width)))) + 8;
    const room = Math.min(byId('mapbox').clientWidth, MOST_HIGH) - this.margin - 2;
    this.cell = Math.max(LEAST_CELL, Math.min(24, Math.floor(room / count)));
    const size = this.margin + this.cell * count + 2;
    this.canvas.width = this.canvas.height = size * sharp;
    this.canvas.style.width = this.canvas.style.height = size + 'px';
    g.scale(sharp, sharp);
    const pair = this.pairs[this.selected], picked = pair ? this.ends(pair) : [];
    this.names.forEach((name, i) => {
      g.font = `${picked.includes(name) ? 600 : 400} 12px system-ui, "DejaVu Sans", sans-serif`;
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
    }
    // A white frame in a dark one is seen on any colour.
    for (const [k, i] of this.at) {
      if (i !== this.selected) continue;
      const x = this.margin + (k % count) * this.cell, y = this.margin + Math.floor(k / count) * this.cell;
      for (const [colour, out] of [['#10151b', 2], ['#ffffff', 0.5]]) {
        g.strokeStyle = colour;
        g.lineWidth = 1.5;
        g.strokeRect(x - 0.5 - out, y - 0.5 - out, this.cell + 2 * out, this.cell + 2 * out);
      }
    }
  }

  // Arrow keys walk from the chosen cell to the next one that way.
  step(event, onSelect) {
    const way = { ArrowDown: [1, 0], ArrowUp: [-1, 0], ArrowRight: [0, 1], ArrowLeft: [0, -1] }[event.key], count = this.names.length;
    if (!way || !this.pairs.length) return;
    event.preventDefault();
    const ends = this.pairs[this.selected] ? this.ends(this.pairs[this.selected]).map(name => this.names.indexOf(name)) : [0, 0];
    let [row, column] = this.cursor && this.at.get(this.cursor[0] * count + this.cursor[1]) === this.selected ? this.cursor : ends;
    do { row += way[0]; column += way[1]; } while (row >= 0 && column >= 0 && row < count && column < count && !this.at.has(row * count + column));
    if (row < 0 || column < 0 || row >= count || column >= count) return;
    this.cursor = [row, column];
    onSelect(this.at.get(row * count + column));
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

// What the page holds, unpacked: the report, its shapes as triangles, its links' poses as matrices.
const byId = id => document.getElementById(id);

// In millimetres, from 10 m on without a fraction; a nought has no sign.
const fixed = (value, digits) => value.toFixed(digits).replace(/^-(0\.?0*)$/, '$1');
const mm = (value, digits = 2) => value === null || value === undefined ? '–' : fixed(1e3 * value, Math.abs(value) < 10 ? digits : 0);
// To three digits, whatever the size.
const brief = value => String(Number(value.toPrecision(3)));

// What is said of a checked pair whose distance is not above the report's margin.
const hitWord = ({ summary: { margin } }) => margin ? `${margin > 0 ? 'within' : 'deeper than'} ${brief(1e3 * Math.abs(margin))} mm` : 'in collision';

// How to shorten one of several names until it `fits`: by what all of them begin with, then by what all end with, then in the middle.
function shortener(names) {
  const all = names.map(name => [...name]);  // letters, which may be two numbers long
  const same = at => { let k = 0; while (all.length > 1 && all.every(name => at(name, k) && at(name, k) === at(all[0], k))) ++k; return k > 3 ? k : 0; };
  const begin = same((name, k) => name[k]), end = same((name, k) => name[name.length - 1 - k]);
  return (name, fits) => {
    if (fits(name)) return name;
    const letters = [...name], part = (from, to) => `${from ? '…' : ''}${letters.slice(from, letters.length - to).join('')}${to ? '…' : ''}`;
    const last = Math.max(0, Math.min(end, letters.length - begin - 1));
    for (let k = 1; k <= begin; ++k) if (fits(part(k, 0))) return part(k, 0);
    for (let k = 1; k <= last; ++k) if (fits(part(begin, k))) return part(begin, k);
    const rest = [...part(begin, last)];
    for (let keep = rest.length - 1; keep > 2; --keep) {
      const head = Math.ceil(0.4 * keep), text = `${rest.slice(0, head).join('')}…${rest.slice(head - keep).join('')}`;
      if (fits(text)) return text;
    }
    return rest[0];
  };
}

// `names` shortened to what `width` pixels hold in the element's font.
function fittedNames(names, element, width) {
  const shorten = shortener(names), pen = document.createElement('canvas').getContext('2d'), style = getComputedStyle(element);
  pen.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
  return new Map(names.map(name => [name, shorten(name, text => pen.measureText(text).width <= width)]));
}

// A column's head that sorts: by a click, Enter or Space.
function sortable(head, onSort) {
  head.tabIndex = 0;
  head.onclick = onSort;
  head.onkeydown = e => {
    if (e.key !== 'Enter' && e.key !== ' ') return;
    e.preventDefault();
    onSort();
  };
}

function showOrder(heads, { key, sign }) {
  for (const head of heads) {
    if (head.dataset.key === key) head.setAttribute('aria-sort', sign > 0 ? 'ascending' : 'descending');
    else head.removeAttribute('aria-sort');
  }
}

// Numbers or names; what is missing comes last either way.
function compared(x, y, sign) {
  const missing = v => v === null || v === undefined || v === '';
  if (missing(x) || missing(y)) return missing(x) - missing(y);
  return sign * (typeof x === 'string' ? x.localeCompare(y) : (x > y) - (x < y));
}

const counted = (count, noun) => `${count} ${noun}${count === 1 ? '' : 's'}`;

function bytes(base64) {
  return Uint8Array.from(atob(base64), c => c.charCodeAt(0));
}

// The text of a packed block.
async function unpacked(id) {
  const stream = new Blob([bytes(byId(id).textContent)]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).text();
}

// An element with its class, its text and what else it holds. Text is never read as HTML.
function make(tag, className = '', text = '', ...children) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  element.append(text, ...children);
  return element;
}

// Corners of a shape, three numbers each: 16-bit steps within its box.
function corners(shape) {
  const steps = new Uint16Array(bytes(shape.corners).buffer);
  return Float32Array.from(steps, (step, i) => shape.low[i % 3] + step * shape.step[i % 3]);
}

// A pose of three rows of four.
function poseOf(rows) {
  return new THREE.Matrix4().set(...rows, 0, 0, 0, 1);
}

// Where the links are at the coordinates `q`: each on its parent, at the joint's origin, slid, then turned. What a joint
// turns by is a rotation vector.
function linkPoses(joints, q) {
  const sum = motions => motions.reduce((v, m) => v.addScaledVector(new THREE.Vector3(...m.axis), m.multiplier * q[m.coordinate] + m.offset), new THREE.Vector3());
  const poses = [];
  for (const joint of joints) {
    const turn = sum(joint.turns), angle = turn.length(), rotation = new THREE.Quaternion().setFromAxisAngle(turn.divideScalar(angle || 1), angle);
    const moved = new THREE.Matrix4().compose(sum(joint.slides), rotation, new THREE.Vector3(1, 1, 1)).premultiply(poseOf(joint.origin));
    poses.push(joint.parent < 0 ? moved : moved.premultiply(poses[joint.parent]));
  }
  return poses;
}

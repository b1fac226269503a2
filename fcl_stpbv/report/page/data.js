// What the page holds, unpacked: the report, its shapes as triangles, its poses as matrices.
const byId = id => document.getElementById(id);
const mm = (value, digits = 2) => value === null || value === undefined ? '–' : (1e3 * value).toFixed(digits);

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

// The pose of link `link` in posture `posture`, as position and quaternion; each number has 16 bits.
class Postures {
  constructor(report) {
    this.values = new Int16Array(bytes(report.postures.values).buffer);
    this.links = report.postures.links;
    this.step = report.postures.step;
  }
  matrix(posture, link) {
    const at = 7 * (posture * this.links + link), v = this.values;
    const position = new THREE.Vector3(v[at], v[at + 1], v[at + 2]).multiplyScalar(this.step);
    const turn = new THREE.Quaternion(v[at + 3], v[at + 4], v[at + 5], v[at + 6]).normalize();
    return new THREE.Matrix4().compose(position, turn, new THREE.Vector3(1, 1, 1));
  }
}

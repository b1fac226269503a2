// What the page holds, unpacked: the report, its shapes as triangles, its links' poses as matrices.
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

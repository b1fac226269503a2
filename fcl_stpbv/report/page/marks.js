// What a task asks of the links: its targets and contacts in the 3-D view, and in a table what is off.
const MARK = { target: 0xc022b8, frame: 0x1b2733, contact: 0xe0b400 };

// Seen through bodies: a target is often inside what it is for. Lengths in m.
function makeMarks(report, size) {
  const group = new THREE.Group(), ball = new THREE.SphereBufferGeometry(1, 16, 12);
  const add = (object, at) => {
    object.material.depthTest = false;
    object.material.transparent = true;  // drawn after all bodies
    object.renderOrder = 4;
    object.applyMatrix(at);
    group.add(object);
  };
  const dot = (colour, x, y, z, part) => {
    const mesh = new THREE.Mesh(ball, new THREE.MeshBasicMaterial({ color: colour, opacity: 0.8 }));
    mesh.scale.setScalar(part * size);
    mesh.position.set(x, y, z);
    add(mesh, new THREE.Matrix4());
  };
  const place = rows => [rows[3], rows[7], rows[11]];
  for (const target of report.targets) {
    if (target.turns) for (const [rows, length] of [[target.frame, 0.6], [target.target, 1]]) add(new THREE.AxesHelper(length * size), poseOf(rows));
    dot(MARK.frame, ...place(target.frame), 0.08);
    dot(MARK.target, ...place(target.target), 0.12);
  }
  for (const contact of report.contacts) for (const point of contact.points) dot(MARK.contact, ...point, 0.1);
  return group;
}

function showTask({ targets, contacts }) {
  if (!targets.length && !contacts.length) return;
  byId('task').hidden = false;
  const legend = (colour, text) => {
    const dot = make('span', 'dot');
    dot.style.background = `#${colour.toString(16).padStart(6, '0')}`;
    byId('marks').append(make('span', 'side', '', dot, text));
  };
  if (targets.length) legend(MARK.target, 'target, with longer axes where a rotation is asked for (red x, green y, blue z)');
  if (targets.length) legend(MARK.frame, 'where the posture has the frame, with shorter axes');
  if (contacts.length) legend(MARK.contact, 'contact point');
  const row = (name, ...cells) => byId('tasktable').tBodies[0].append(make('tr', '', '', make('td', '', name), ...cells.map(text => make('td', 'n', text))));
  for (const target of targets) row(target.name, mm(target.off, 3), target.turns ? fixed(target.turned * 180 / Math.PI, 4) : 'free');
  for (const { link, points } of contacts) row(`${link}: ${points.length === 1 ? '1 contact point' : `${points.length} contact points`}`, '', '');
}

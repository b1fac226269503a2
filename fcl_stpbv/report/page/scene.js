// The robot in 3-D: every body where the selected pair's posture puts it, the pair's two links in colour, the witness
// segment between them. Drawn only when something changes: coarsely while it moves, then once more with smooth edges.

// Faces that meet at less than this are drawn as one smooth surface (cosine of 50 degrees).
const CREASE = 0.64;
// Pixels drawn for one on the screen once nothing has moved for STILL milliseconds. (WebGL's own smoothing more than
// doubles the time of every frame where there is no graphics card.)
const SMOOTHING = 2, STILL = 250;
const COLOUR = { link: 0xaebccb, first: 0xf08a24, second: 0x3d8bf0, obstacle: 0x74a98a, witness: 0xd3180c };

// Triangles with a normal for each corner: the mean of the faces around it, by their areas, without those past a crease.
function smoothGeometry(shape) {
  const place = corners(shape), corner = new Uint16Array(bytes(shape.triangles).buffer), count = corner.length / 3;
  const normals = [], around = Array.from({ length: place.length / 3 }, () => []);
  const at = i => new THREE.Vector3().fromArray(place, 3 * i);
  for (let t = 0; t < count; ++t) {
    const [a, b, c] = [0, 1, 2].map(k => at(corner[3 * t + k]));
    normals.push(b.sub(a).cross(c.sub(a)));
    for (let k = 0; k < 3; ++k) around[corner[3 * t + k]].push(t);
  }
  // Corners of one place and one normal are one vertex: fewer to turn in every frame.
  const position = [], normal = [], index = [], known = new Map(), sum = new THREE.Vector3();
  for (let i = 0; i < 3 * count; ++i) {
    const own = normals[Math.floor(i / 3)], length = own.length();
    sum.set(0, 0, 0);
    for (const t of around[corner[i]]) if (normals[t].dot(own) >= CREASE * length * normals[t].length()) sum.add(normals[t]);
    const key = `${corner[i]} ${sum.normalize().toArray().map(x => x.toFixed(2))}`;
    if (!known.has(key)) {
      known.set(key, known.size);
      position.push(...at(corner[i]).toArray());
      normal.push(...sum.toArray());
    }
    index.push(known.get(key));
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(position, 3));
  geometry.setAttribute('normal', new THREE.Float32BufferAttribute(normal, 3));
  geometry.setIndex(index);
  geometry.computeBoundingSphere();
  return geometry;
}

// A body that is only context: its outline glows, its faces are clear.
function ghostMaterial(colour) {
  return new THREE.ShaderMaterial({
    uniforms: { colour: { value: new THREE.Color(colour) } }, transparent: true, depthWrite: false,
    vertexShader: `varying vec3 turned; varying vec3 eye;
      void main() { vec4 at = modelViewMatrix * vec4(position, 1.0); turned = normalMatrix * normal; eye = -at.xyz;
        gl_Position = projectionMatrix * at; }`,
    fragmentShader: `uniform vec3 colour; varying vec3 turned; varying vec3 eye;
      void main() { float facing = abs(dot(normalize(turned), normalize(eye)));
        gl_FragColor = vec4(colour, 0.05 + 0.4 * pow(1.0 - facing, 2.5)); }`
  });
}

class Scene {
  constructor(report, canvas) {
    this.report = report;
    this.canvas = canvas;
    this.show = 'all';
    this.pair = null;
    this.frames = 0;
    this.renderer = new THREE.WebGLRenderer({ canvas, alpha: true });
    this.camera = new THREE.PerspectiveCamera(28, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.world = new THREE.Scene();
    const lamp = new THREE.DirectionalLight(0xffffff, 0.6);
    lamp.position.set(-0.6, 0.9, 1.2);
    this.camera.add(lamp);
    this.world.add(this.camera, new THREE.HemisphereLight(0xffffff, 0x7d8a99, 0.55));
    this.material = {};
    for (const kind of ['link', 'first', 'second']) this.material[kind] = new THREE.MeshLambertMaterial({ color: COLOUR[kind] });
    this.material.obstacle = new THREE.MeshLambertMaterial({ color: COLOUR.obstacle, transparent: true, opacity: 0.38, depthWrite: false });
    this.material.pickedObstacle = new THREE.MeshLambertMaterial({ color: COLOUR.second, transparent: true, opacity: 0.5, depthWrite: false });
    this.material.ghost = ghostMaterial(0x6f8296);
    const geometries = report.shapes.map(smoothGeometry);
    this.bodies = report.bodies.map(body => {
      const mesh = new THREE.Mesh(geometries[body.shape], this.material.link);
      mesh.matrixAutoUpdate = false;
      this.world.add(mesh);
      return mesh;
    });
    this.makeWitness();
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.screenSpacePanning = true;
    this.controls.addEventListener('change', () => this.redraw());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.place(0);
    this.addMarks();
    this.look(0.8, 0.3);
    this.addFloor();
  }

  // The segment is seen through bodies too, more faintly.
  makeWitness() {
    this.witness = new THREE.Group();
    const rod = new THREE.CylinderBufferGeometry(1, 1, 1, 12), ball = new THREE.SphereBufferGeometry(1, 16, 12);
    rod.rotateX(Math.PI / 2);
    for (const hidden of [false, true]) {
      const material = new THREE.MeshBasicMaterial({ color: COLOUR.witness, transparent: hidden, opacity: hidden ? 0.45 : 1, depthTest: !hidden });
      for (const geometry of [rod, ball, ball]) {
        const mesh = new THREE.Mesh(geometry, material);
        mesh.renderOrder = hidden ? 3 : 2;
        this.witness.add(mesh);
      }
    }
    this.world.add(this.witness);
  }

  // Targets may lie beyond all bodies.
  addMarks() {
    this.marks = makeMarks(this.report, 0.15 * this.extent.radius);
    this.world.add(this.marks);
    this.place(0);
  }

  addFloor() {
    const box = this.bounds(this.bodies), size = box.getSize(new THREE.Vector3()), side = Math.max(size.x, size.y, 1e-3) * 1.6;
    const step = 10 ** Math.round(Math.log10(side / 12)), lines = 2 * Math.ceil(side / step / 2);
    const floor = new THREE.GridHelper(lines * step, lines, 0x8fa0b2, 0x8fa0b2);
    floor.material.transparent = true;
    floor.material.opacity = 0.25;
    floor.material.depthWrite = false;
    floor.rotateX(Math.PI / 2);
    const middle = box.getCenter(new THREE.Vector3());
    floor.position.set(middle.x, middle.y, box.min.z - 0.002 * side);
    this.world.add(floor);
  }

  place(posture) {
    const links = linkPoses(this.report.kinematics, this.report.configurations[posture]);
    this.report.bodies.forEach((body, i) => {
      const at = poseOf(body.at);
      if (body.link >= 0) at.premultiply(links[body.link]);
      this.bodies[i].matrix.copy(at);
      this.bodies[i].updateMatrixWorld(true);
    });
    this.extent = this.bounds(this.marks ? [...this.bodies, this.marks] : this.bodies).getBoundingSphere(new THREE.Sphere());
  }

  // The two links of a pair, in their posture; `fly` brings them into the middle.
  select(pair, fly) {
    this.pair = pair;
    this.place(pair.posture);
    this.recolour();
    if (fly) this.frame();
    this.redraw();
  }

  showOnly(what) {
    this.show = what;
    this.recolour();
    this.redraw();
  }

  // 0 for a body of the pair's first link, 1 for one of its second, -1 for others.
  side(body) {
    if (!this.pair) return -1;
    if (!body.obstacle && body.owner === this.pair.link1) return 0;
    return body.obstacle === this.pair.obstacle && body.owner === this.pair.link2 ? 1 : -1;
  }

  recolour() {
    // Two links that overlap are drawn clear: one may be inside the other.
    const overlap = !!this.pair && this.pair.distance < 0, clear = { transparent: overlap, depthWrite: !overlap, opacity: overlap ? 0.6 : 1 };
    for (const kind of ['first', 'second']) Object.assign(this.material[kind], clear);
    this.marks.visible = this.show !== 'pair';
    this.report.bodies.forEach((body, i) => {
      const side = this.side(body), mesh = this.bodies[i];
      mesh.visible = !body.split && (side >= 0 || this.show !== 'pair' || !this.pair);  // its parts are drawn
      mesh.material = side >= 0 ? this.material[side === 0 ? 'first' : body.obstacle ? 'pickedObstacle' : 'second']
        : this.show === 'context' && this.pair ? this.material.ghost : this.material[body.obstacle ? 'obstacle' : 'link'];
      mesh.renderOrder = mesh.material.transparent ? 1 : 0;
    });
  }

  bounds(meshes) {
    const box = new THREE.Box3();
    for (const mesh of meshes) box.union(new THREE.Box3().setFromObject(mesh));
    return box.isEmpty() ? new THREE.Box3(new THREE.Vector3(-0.5, -0.5, -0.5), new THREE.Vector3(0.5, 0.5, 0.5)) : box;
  }

  // Moves the camera so that what is shown, or the pair where it is isolated, fills the view.
  frame(zoom = 1) {
    const isolated = this.pair && this.show !== 'all';
    const meshes = this.bodies.filter((_, i) => isolated ? this.side(this.report.bodies[i]) >= 0 : !this.report.bodies[i].obstacle);
    const box = this.bounds(!meshes.length ? this.bodies : isolated ? meshes : [...meshes, this.marks]);
    if (!isolated && this.pair && this.pair.obstacle) this.addObstacle(box);
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    const half = Math.min(1, this.camera.aspect) * Math.tan(this.camera.fov * Math.PI / 360);
    const way = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.copy(sphere.center);
    this.camera.position.copy(sphere.center).addScaledVector(way, sphere.radius / half / zoom);
    this.controls.update();
    this.redraw();
  }

  // The pair's obstacle too, as far as it is not much larger than the robot, as a floor is.
  addObstacle(box) {
    const own = this.bounds(this.bodies.filter((_, i) => this.side(this.report.bodies[i]) === 1)), robot = box.getBoundingSphere(new THREE.Sphere());
    const most = new THREE.Vector3(1, 1, 1).multiplyScalar(1.5 * robot.radius);
    box.union(own.intersect(new THREE.Box3(robot.center.clone().sub(most), robot.center.clone().add(most))));
  }

  // An obstacle must not hide the robot: seen across the normal of the two, a little from the robot's side. Without one as asked.
  clearYaw(otherwise) {
    if (!this.pair || !this.pair.obstacle || !this.pair.point1) return otherwise;
    const robot = this.bounds(this.bodies.filter((_, i) => !this.report.bodies[i].obstacle)).getCenter(new THREE.Vector3());
    const normal = new THREE.Vector3(...this.pair.normal).setZ(0);
    if (normal.length() < 0.3) return otherwise;  // the obstacle is below or above
    const inward = Math.sign(normal.dot(robot.sub(new THREE.Vector3(...this.pair.point2)))) || 1;
    const away = Math.atan2(inward * normal.y, inward * normal.x), seen = [away + 1.1, away - 1.1];
    return Math.cos(seen[0] - otherwise) > Math.cos(seen[1] - otherwise) ? seen[0] : seen[1];
  }

  // From a side: yaw about the vertical (0 looks along -x, at the robot's front), pitch above the floor (rad).
  look(yaw, pitch, zoom) {
    const across = Math.cos(Math.min(pitch, 1.57));
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3(across * Math.cos(yaw), across * Math.sin(yaw), Math.sin(pitch)));
    this.frame(zoom);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.sized) this.frame(this.firstZoom);
    this.sized = true;
    this.draw();  // at once: a canvas of another size is empty
  }

  // As thick on the screen wherever it is.
  updateWitness() {
    this.witness.visible = !!this.pair && !!this.pair.point1;
    if (!this.witness.visible) return;
    const a = new THREE.Vector3(...this.pair.point1), b = new THREE.Vector3(...this.pair.point2), middle = a.clone().lerp(b, 0.5);
    const pixel = this.camera.position.distanceTo(middle) * 2 * Math.tan(this.camera.fov * Math.PI / 360) / this.canvas.clientHeight;
    this.witness.children.forEach((mesh, i) => {
      const thick = pixel * (i % 3 === 0 ? 1.3 : 3.4);
      mesh.position.copy([middle, a, b][i % 3]);
      mesh.scale.set(thick, thick, i % 3 === 0 ? Math.max(a.distanceTo(b), 1e-9) : thick);
      if (i % 3 === 0) mesh.lookAt(b);
    });
  }

  redraw() {
    if (this.asked) return;
    this.asked = requestAnimationFrame(() => this.draw());
  }

  draw(sharp = false) {
    cancelAnimationFrame(this.asked);
    this.asked = 0;
    clearTimeout(this.later);
    if (!sharp) this.later = setTimeout(() => this.draw(true), STILL);
    const ratio = window.devicePixelRatio * (sharp ? SMOOTHING : 1);
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    // Near and far enclose the world as tightly as they can: the depth buffer has few bits.
    const away = this.camera.position.distanceTo(this.extent.center), reach = 2 * this.extent.radius;
    this.camera.far = away + reach;
    this.camera.near = Math.max(away - reach, this.camera.position.distanceTo(this.controls.target) / 50);
    this.camera.updateProjectionMatrix();
    this.updateWitness();
    this.renderer.render(this.world, this.camera);
    ++this.frames;
  }
}

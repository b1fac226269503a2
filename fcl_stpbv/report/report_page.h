// The page that toHtml() fills in: layout, table, heat map and a small 3-D view on a plain canvas. It loads
// nothing from anywhere, so that a report can be mailed and opened offline.
#pragma once

namespace fcl_stpbv::report {

/// Goes before the data, which is a JSON object.
constexpr const char* kPageHead = R"PAGE(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Collision report</title>
<style>
 body { margin: 0; font: 14px system-ui, sans-serif; color: #223; background: #f4f5f7 }
 header { padding: 12px 20px; background: #1f2d3d; color: #fff } h1 { font-size: 18px; margin: 0 }
 header p { margin: 4px 0 0; color: #c8d2dd } main { display: flex; flex-wrap: wrap; gap: 16px; padding: 16px }
 section { background: #fff; border: 1px solid #d9dee4; border-radius: 6px; padding: 10px }
 #tablebox { flex: 1 1 620px; max-height: 560px; overflow: auto } table { border-collapse: collapse; width: 100% }
 th { position: sticky; top: -10px; background: #fff; cursor: pointer; text-align: left; border-bottom: 2px solid #d9dee4 }
 th, td { padding: 3px 8px; white-space: nowrap } td.n { text-align: right; font-variant-numeric: tabular-nums }
 tr.off td { color: #8a94a0 } tr.hit td { color: #b3261e } tbody tr:hover { background: #eef3f9 }
 tr.sel td { background: #ffe9a8 } canvas { display: block } #view { cursor: grab; touch-action: none }
 #detail { font-size: 13px; margin-top: 6px; min-height: 3.4em; max-width: 640px }
</style></head><body>
<header><h1 id="title"></h1><p id="summary"></p></header>
<main>
 <section><canvas id="view" width="640" height="520"></canvas><div id="detail">Drag to orbit, wheel to zoom.</div></section>
 <section id="tablebox"><table><thead><tr></tr></thead><tbody></tbody></table></section>
 <section><canvas id="heat" width="640" height="640"></canvas></section>
</main>
<script>
const report = )PAGE";

/// Goes after the data.
constexpr const char* kPageTail = R"PAGE(;
'use strict';
const $ = id => document.getElementById(id), mm = v => v === null ? '-' : (1e3 * v).toFixed(3);
const pairs = report.pairs, bodies = report.bodies;
let selected = 0, yaw = 0.8, pitch = 0.35, zoom = 1, sortKey = null, sortSign = 1;

$('title').textContent = report.robot + ': ' + report.title;
$('summary').textContent = `${report.summary.pairs_total} pairs, ${report.summary.checked} checked, ` +
  `${report.summary.colliding} in collision, least distance ${mm(report.summary.min_distance)} mm` +
  (report.summary.ns_per_pair ? `, ${report.summary.ns_per_pair.toFixed(0)} ns a pair` : '') + (report.pose ? `, posture ${report.pose}` : ', closest configurations');

const columns = [['link1', 'link 1'], ['link2', 'link 2'], ['distance', 'STP-BV [mm]'], ['hull_distance', 'hulls [mm]'],
                 ['cover', 'cover [mm]'], ['reason', 'reason'], ['srdf_reason', 'SRDF']];
for (const [key, label] of columns) {
  const th = document.createElement('th');
  th.textContent = label;
  th.onclick = () => { sortSign = sortKey === key ? -sortSign : 1; sortKey = key; fillTable(); };
  document.querySelector('thead tr').append(th);
}

function fillTable() {
  const order = pairs.map((_, i) => i), last = v => v === null ? Infinity : v;
  if (sortKey) order.sort((a, b) => {
    const x = last(pairs[a][sortKey]), y = last(pairs[b][sortKey]);
    return sortSign * (x < y ? -1 : x > y ? 1 : 0);
  });
  const body = document.querySelector('tbody');
  body.replaceChildren(...order.map(i => {
    const row = document.createElement('tr'), p = pairs[i];
    row.className = (p.checked ? p.distance <= 0 ? 'hit' : '' : 'off') + (i === selected ? ' sel' : '');
    row.dataset.pair = i;
    for (const [key] of columns) {
      const cell = row.insertCell(), value = p[key];
      const isNumber = ['distance', 'hull_distance', 'cover'].includes(key);
      cell.textContent = isNumber ? mm(value) : value;
      if (isNumber) cell.className = 'n';
    }
    row.onclick = () => select(i);
    return row;
  }));
}

function select(i) {
  selected = i;
  for (const row of document.querySelectorAll('tbody tr')) row.classList.toggle('sel', +row.dataset.pair === i);
  const p = pairs[i];
  const slopes = Object.entries(p.gradient).sort((a, b) => Math.abs(b[1]) - Math.abs(a[1])).slice(0, 6);
  $('detail').textContent = `${p.link1} - ${p.link2}: ${mm(p.distance)} mm, normal (${p.normal.map(v => v.toFixed(3)).join(', ')}), ` +
    `gradient ${slopes.map(([j, v]) => `${v >= 0 ? '+' : ''}${v.toFixed(3)} ${j}`).join(', ')}`;
  document.body.dataset.selected = i;
  draw();
  drawHeat();
}

// Heat map: links against links, by distance.
const names = [...new Set(pairs.flatMap(p => [p.link1, p.link2]))];
const indexOf = new Map(names.map((n, i) => [n, i])), pairAt = new Map();
pairs.forEach((p, i) => {
  const a = indexOf.get(p.link1), b = indexOf.get(p.link2);
  pairAt.set(a * names.length + b, i);
  pairAt.set(b * names.length + a, i);
});
const margin = 110;
const cellSize = () => (640 - margin) / Math.max(1, names.length);
function heatColor(p) {
  if (!p.checked) return '#e3e6ea';
  if (p.distance <= 0) return '#b3261e';
  const t = Math.min(1, p.distance / 0.3);
  return `hsl(${30 + 180 * t}, 75%, ${55 + 20 * t}%)`;
}
function drawHeat() {
  const g = $('heat').getContext('2d'), s = cellSize();
  g.clearRect(0, 0, 640, 640);
  g.font = Math.min(11, s) + 'px system-ui, sans-serif';
  g.fillStyle = '#223';
  names.forEach((n, i) => {
    g.textAlign = 'right';
    g.fillText(n, margin - 4, margin + (i + 0.8) * s);
    g.save();
    g.translate(margin + (i + 0.8) * s, margin - 4);
    g.rotate(-Math.PI / 2);
    g.textAlign = 'left';
    g.fillText(n, 0, 0);
    g.restore();
  });
  for (const [k, i] of pairAt) {
    const a = Math.floor(k / names.length), b = k % names.length;
    g.fillStyle = heatColor(pairs[i]);
    g.fillRect(margin + b * s, margin + a * s, s - 0.5, s - 0.5);
    if (i === selected) { g.strokeStyle = '#000'; g.lineWidth = 2; g.strokeRect(margin + b * s, margin + a * s, s, s); }
  }
}
$('heat').onclick = e => {
  const s = cellSize(), a = Math.floor((e.offsetY - margin) / s), b = Math.floor((e.offsetX - margin) / s);
  const i = pairAt.get(a * names.length + b);
  if (a >= 0 && b >= 0 && i !== undefined) select(i);
};

// 3-D view: triangles sorted from back to front. Poses are rows of [R t], 12 numbers a body.
function place(pose, v) {
  return [pose[0] * v[0] + pose[1] * v[1] + pose[2] * v[2] + pose[3], pose[4] * v[0] + pose[5] * v[1] + pose[6] * v[2] + pose[7],
          pose[8] * v[0] + pose[9] * v[1] + pose[10] * v[2] + pose[11]];
}
function draw() {
  const canvas = $('view'), g = canvas.getContext('2d'), w = canvas.width, h = canvas.height;
  g.fillStyle = '#eef1f5';
  g.fillRect(0, 0, w, h);
  if (!pairs.length) return;
  const pair = pairs[selected], poses = report.poses[pair.pose], cy = Math.cos(yaw), sy = Math.sin(yaw);
  const cp = Math.cos(pitch), sp = Math.sin(pitch);
  const turn = v => { const x = cy * v[0] + sy * v[1], y = cy * v[1] - sy * v[0]; return [y, cp * v[2] - sp * x, cp * x + sp * v[2]]; };
  const turned = bodies.map((b, i) => b.v.map(v => turn(place(poses[i], v))));
  const low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
  for (const list of turned) for (const v of list) for (let k = 0; k < 3; ++k) {
    low[k] = Math.min(low[k], v[k]);
    high[k] = Math.max(high[k], v[k]);
  }
  const scale = zoom * 0.92 * Math.min(w / (high[0] - low[0]), h / (high[1] - low[1]));
  const toX = v => w / 2 + scale * (v[0] - (low[0] + high[0]) / 2), toY = v => h / 2 - scale * (v[1] - (low[1] + high[1]) / 2);
  const faces = [];
  bodies.forEach((b, i) => {
    const list = turned[i], mine = i === pair.body1 || i === pair.body2;
    for (const t of b.t) {
      const [p, q, r] = [list[t[0]], list[t[1]], list[t[2]]];
      const e = [q[0] - p[0], q[1] - p[1], q[2] - p[2]], f = [r[0] - p[0], r[1] - p[1], r[2] - p[2]];
      const n = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
      if (n[2] <= 0) continue;
      const length = Math.hypot(...n), light = Math.max(0, (0.3 * n[0] + 0.5 * n[1] + 0.8 * n[2]) / length);
      faces.push([p[2] + q[2] + r[2], p, q, r, mine, 40 + 45 * light, b.obstacle]);
    }
  });
  faces.sort((a, b) => a[0] - b[0]);
  for (const [, p, q, r, mine, light, obstacle] of faces) {
    g.fillStyle = g.strokeStyle = mine ? `hsl(38, 90%, ${light * 0.8}%)` : `hsl(${obstacle ? 120 : 212}, 22%, ${light}%)`;
    g.globalAlpha = obstacle ? 0.35 : 1;  // the robot shows through
    g.beginPath();
    g.moveTo(toX(p), toY(p));
    g.lineTo(toX(q), toY(q));
    g.lineTo(toX(r), toY(r));
    g.closePath();
    g.fill();
    if (!obstacle) g.stroke();
  }
  g.globalAlpha = 1;
  const a = turn(pair.point1), b = turn(pair.point2);
  g.strokeStyle = g.fillStyle = '#d0021b';
  g.lineWidth = 2.5;
  g.beginPath();
  g.moveTo(toX(a), toY(a));
  g.lineTo(toX(b), toY(b));
  g.stroke();
  for (const v of [a, b]) { g.beginPath(); g.arc(toX(v), toY(v), 3.5, 0, 7); g.fill(); }
  g.lineWidth = 1;
}
let drag = null;
$('view').onpointerdown = e => { drag = [e.clientX, e.clientY]; $('view').setPointerCapture(e.pointerId); };
$('view').onpointerup = () => { drag = null; };
$('view').onpointermove = e => {
  if (!drag) return;
  yaw -= (e.clientX - drag[0]) * 0.01;
  pitch = Math.max(-1.57, Math.min(1.57, pitch + (e.clientY - drag[1]) * 0.01));
  drag = [e.clientX, e.clientY];
  draw();
};
$('view').onwheel = e => { e.preventDefault(); zoom *= Math.exp(-e.deltaY * 0.001); draw(); };

// A page opened as report.html#yaw,pitch,zoom,row shows that view.
const [asYaw, asPitch, asZoom, asRow] = location.hash.slice(1).split(',').map(Number);
if (asZoom > 0) { yaw = asYaw; pitch = asPitch; zoom = asZoom; }
fillTable();
if (pairs.length) select(pairs[asRow] ? asRow : 0);
</script></body></html>
)PAGE";

}  // namespace fcl_stpbv::report

// The chart of a trajectory: a cursor tells the least distance and its pair, a click puts the robot there.

// Of the pair that touches first, that moment; null of others.
function firstContact(report, pair) {
  const contact = report.trajectory && report.trajectory.contact;
  return contact && report.pairs[contact.pair] === pair ? contact : null;
}

class Chart {
  constructor(report, onMoment) {
    this.report = report;
    this.chart = document.querySelector('#trajectory svg');
    if (!this.chart) return;
    const { distance } = report.trajectory.chart;
    this.showMoments(onMoment, distance.indexOf(Math.min(...distance)));
    this.chart.onmousemove = e => this.tell(this.at(e));
    this.chart.onmouseleave = () => this.tell(-1);
    this.chart.onclick = e => { const k = this.at(e); if (k >= 0) onMoment(...this.moment(k)); };
  }

  timeText(k) {
    const { trajectory } = this.report;
    return trajectory.chart.time_text[k];
  }

  pairOf(k) {
    return this.report.pairs[this.report.trajectory.chart.pair[k]];
  }

  // The pair that is nearest then, and the moment.
  moment(k) {
    const { share, distance, pair, posture } = this.report.trajectory.chart;
    const seen = { label: 'Shown', posture: posture[k], distance: distance[k], time_text: this.timeText(k), time_share: share[k], point1: null };
    return [pair[k], seen];
  }

  // The first contact and the closest approach, in words under the chart.
  showMoments(onMoment, nearest) {
    const { contact, chart } = this.report.trajectory;
    const add = (what, time, distance, pair, onClick) => {
      const button = make('button', '', `${what}: ${time}, ${mm(distance, 3)} mm, ${pair.link1} – ${pair.link2}`);
      button.onclick = onClick;
      byId('instants').append(button);
    };
    if (contact) add('First contact', contact.time_text, contact.distance, this.report.pairs[contact.pair], () => onMoment(contact.pair, contact));
    add('Closest', this.timeText(nearest), chart.distance[nearest], this.pairOf(nearest), () => onMoment(chart.pair[nearest], null));
  }

  x(share) {
    const { left, right } = this.chart.dataset;
    return Number(left) + share * (right - left);
  }

  // The sample nearest to the mouse; -1 outside of the axes.
  at(event) {
    const box = this.chart.getBoundingClientRect(), { left, right } = this.chart.dataset, { share } = this.report.trajectory.chart;
    const seen = ((event.clientX - box.left) / box.width * this.chart.viewBox.baseVal.width - left) / (right - left);
    if (seen < -0.01 || seen > 1.01) return -1;
    return share.reduce((best, at, k) => Math.abs(at - seen) < Math.abs(share[best] - seen) ? k : best, 0);
  }

  line(id, share) {
    const line = this.chart && this.chart.querySelector(id), x = share === undefined ? -9 : this.x(share);
    if (!line) return;
    line.setAttribute('x1', x);
    line.setAttribute('x2', x);
  }

  tell(k) {
    const tip = byId('instant'), { share, distance } = this.report.trajectory.chart;
    tip.hidden = k < 0;
    this.line('#cursor', k < 0 ? undefined : share[k]);
    if (k < 0) return;
    const pair = this.pairOf(k), box = byId('trajectory'), chart = this.chart.getBoundingClientRect();
    tip.textContent = `${this.timeText(k)}: ${mm(distance[k], 3)} mm, ${pair.link1} – ${pair.link2}`;
    const x = chart.left - box.getBoundingClientRect().left + box.scrollLeft + this.x(share[k]) * chart.width / this.chart.viewBox.baseVal.width;
    tip.style.left = `${Math.max(4, Math.min(x + 12, box.scrollLeft + box.clientWidth - tip.offsetWidth - 4))}px`;
  }

  // Where the chosen pair is shown: a share of the whole time, none of a pair that was not followed.
  mark(share) {
    this.line('#chosen', share);
  }
}

// The strip below the controls: rotations, patterns, impacts and ground acceleration around the time shown.

function shown(run, state) {
  const length = state.window === 0 ? run.end : Math.min(state.window, run.end);
  const from = clamp(state.time - length / 2, 0, run.end - length);
  return [from, from + length];
}

function drawStrip(view, data, run, state) {
  const { width, height } = fit(view.strip, 0.62);
  const g = view.strip.getContext("2d");
  g.clearRect(0, 0, width, height);
  const [from, to] = shown(run, state);
  const x = (time) => ((time - from) / (to - from)) * width;
  const parts = [0, 0.5, 0.6, 0.68, 1].map((share) => share * height);
  const first = Math.max(0, Math.floor(from / data.step) - 1);
  const last = Math.min(run.rows - 1, Math.ceil(to / data.step) + 1);
  const along = (row) => x(row * data.step);
  // A line of text above rotations and ground, so that no trace runs through it.
  const line = Math.max(14, width / 30);
  const top = Math.max(...data.alpha.map((alpha) => run.largest / alpha)) || 1;
  [data.theta1, data.theta2].slice(0, data.cracked ? 2 : 1).forEach((list, body) => {
    curve(g, list, 1 / data.perRad / data.alpha[body] / top, data.bodyColours[body], [parts[0] + line, parts[1]], [first, last], along);
  });
  run.changes.forEach(([row, index], i) => {
    const until = run.changes[i + 1] ? run.changes[i + 1][0] : run.rows;
    if (row * data.step > to || until * data.step < from) return;
    g.fillStyle = data.patternColours[index];
    g.fillRect(along(row), parts[1], Math.max(1, along(until) - along(row)), parts[2] - parts[1]);
  });
  g.lineWidth = width / 700;
  for (const [time, , rate] of data.impacts) {
    if (time < from || time > to) continue;
    const tall = (0.15 + 0.85 * (rate / run.fastest)) * (parts[3] - parts[2] - 2);
    upright(g, x(time), parts[3], parts[3] - tall, INK);
  }
  const shaken = Math.min(last, data.ground.length - 1);
  curve(g, data.ground, 1 / data.perMS2 / run.strongest, "#555", [parts[3] + line, parts[4]], [first, shaken], along);
  labels(g, line, parts, `±${top.toPrecision(2)}`, data.ground.length > 0 ? run.strongest : 0);
  g.lineWidth = width / 350;
  upright(g, x(state.time), 0, height, "#a50f15");
  view.span.textContent = `${from.toFixed(2)} s to ${to.toFixed(2)} s`;
}

function upright(g, x, from, to, colour) {
  g.strokeStyle = colour;
  path(g, [[x, from], [x, to]]);
  g.stroke();
}

function curve(g, list, scale, colour, [top, bottom], [first, last], along) {
  const middle = (top + bottom) / 2;
  const half = ((bottom - top) / 2) * 0.92;
  g.lineWidth = 1;
  g.strokeStyle = "#ddd";
  path(g, [[0, middle], [g.canvas.width, middle]]);
  g.stroke();
  const points = [];
  for (let row = first; row <= last; row += 1) points.push([along(row), middle - list[row] * scale * half]);
  path(g, points);
  g.strokeStyle = colour;
  g.lineWidth = g.canvas.width / 450;
  g.stroke();
}

function labels(g, line, parts, rotations, strongest) {
  g.font = `${Math.max(10, Math.round(0.62 * line))}px system-ui, sans-serif`;
  g.textAlign = "left";
  g.fillStyle = "#666";
  const down = 0.78 * line;
  g.fillText(`θ/α, ${rotations}`, 4, parts[0] + down);
  g.fillText(strongest > 0 ? `ground, ±${strongest.toPrecision(2)} m/s²` : "ground at rest", 4, parts[3] + down);
}

// A line in each static history that follows the time; a press on the history sets it.
function cursors(set) {
  const all = [...document.querySelectorAll("svg[data-from]")].map((svg) => {
    const number = (name) => Number(svg.dataset[name]);
    const [left, right, from, to] = ["left", "right", "from", "to"].map(number);
    const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
    const height = svg.viewBox.baseVal.height;
    for (const [name, value] of [["y1", 0.05 * height], ["y2", 0.92 * height], ["stroke", "#a50f15"], ["stroke-width", 3], ["class", "cursor"]]) line.setAttribute(name, value);
    svg.append(line);
    svg.addEventListener("click", (event) => {
      const at = svg.getBoundingClientRect();
      const x = ((event.clientX - at.left) / at.width) * svg.viewBox.baseVal.width;
      set(from + ((x - left) / (right - left)) * (to - from));
    });
    return (time) => {
      const x = left + ((time - from) / (to - from)) * (right - left);
      line.setAttribute("x1", x);
      line.setAttribute("x2", x);
      line.setAttribute("visibility", time < from || time > to ? "hidden" : "visible");
    };
  });
  return (time) => all.forEach((move) => move(time));
}

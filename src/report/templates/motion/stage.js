// The stage: the wall, its floor and the ground, drawn on a canvas.

const STATES = {
  rest: "both joints closed",
  1: "both joints open, both bodies turn about corners of the same side",
  2: "both joints open, the bodies turn about corners of opposite sides",
  3: "only the ground joint open: the wall rocks as one body",
  4: "only the crack open: the upper body rocks on a standing lower one",
};
const FLASH_S = 0.35; // of the viewer's time
const INK = "#222";

const burning = (flash) => (performance.now() - flash.born) / 1000 / FLASH_S < 1;

function drawStage(view, data, run, state) {
  const { width, height } = fit(view.stage, 1.2);
  const g = view.stage.getContext("2d");
  g.clearRect(0, 0, width, height);
  const tall = data.heights[0] + data.heights[1];
  const scale = Math.min((height * 0.72) / tall, (width * 0.5) / (tall * 0.55));
  const origin = [width / 2, height * 0.86];
  const px = ([x, y]) => [origin[0] + scale * x, origin[1] - scale * y];
  const pattern = run.patternAt(state.time);
  const signs = data.signs[pattern];
  const shape = posture(data, signs, run.theta(state.time).map((angle) => angle * state.magnification));
  drawGround(g, width, origin, scale * data.thickness);
  drawSpring(g, px(shape.top), px(shape.rest), width, data.stiffness > 0);
  drawBody(g, shape.lower.map(px), data.bodyColours[0]);
  if (data.cracked) drawBody(g, shape.upper.map(px), data.bodyColours[1]);
  // Corners in contact.
  if (signs[0] !== 0) dot(g, px(shape.pivot), 5, INK);
  if (data.cracked && signs[1] !== 0) dot(g, px(shape.crack), 5, INK);
  for (const flash of state.flashes.filter(burning)) {
    const age = (performance.now() - flash.born) / 1000 / FLASH_S;
    if (flash.joints & 1) burst(g, px(shape.pivot), flash.strength, age);
    if (flash.joints & 2) burst(g, px(shape.crack), flash.strength, age);
  }
  if (data.ground.length > 0) drawArrow(g, width, height, run.ground(state.time) / run.strongest);
  if (data.collapse !== null && state.time >= run.end - data.step) drawCollapse(g, width, height);
  tellState(view, data, run, state, pattern);
}

function tellState(view, data, run, state, pattern) {
  const name = data.patternNames[pattern];
  const rests = name === "rest";
  view.pattern.textContent = rests ? name : `pattern ${name}`;
  view.pattern.style.color = rests ? "#666" : data.patternColours[pattern > 4 ? pattern - 4 : pattern];
  view.meaning.textContent = STATES[rests ? name : name[0]];
  const [r1, r2] = run.theta(state.time).map((angle, i) => (angle / data.alpha[i]).toFixed(3).replace("-", "−"));
  view.values.textContent = data.cracked ? `θ₁/α₁ = ${r1}, θ₂/α₂ = ${r2}` : `θ/α = ${r1}`;
}

function drawCollapse(g, width, height) {
  g.fillStyle = "#a50f15";
  g.font = `600 ${Math.round(width / 22)}px system-ui, sans-serif`;
  g.textAlign = "center";
  g.fillText("collapse", width / 2, height * 0.06);
}

function fit(canvas, ratio) {
  const dense = devicePixelRatio || 1;
  const width = Math.round(canvas.clientWidth * dense);
  const height = Math.round(canvas.clientWidth * ratio * dense);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  return { width, height };
}

function path(g, points) {
  g.beginPath();
  points.forEach(([x, y], i) => (i === 0 ? g.moveTo(x, y) : g.lineTo(x, y)));
}

function drawBody(g, points, colour) {
  path(g, points);
  g.closePath();
  g.globalAlpha = 0.28;
  g.fillStyle = colour;
  g.fill();
  g.globalAlpha = 1;
  g.lineWidth = 2;
  g.strokeStyle = colour;
  g.stroke();
}

function drawGround(g, width, [x, y], thick) {
  const half = Math.max(2.2 * thick, width * 0.14);
  g.strokeStyle = INK;
  g.lineWidth = 2;
  path(g, [[x - half, y], [x + half, y]]);
  g.stroke();
  g.lineWidth = 1;
  for (let at = x - half; at < x + half; at += 14) {
    path(g, [[at + 10, y], [at, y + 10]]);
    g.stroke();
  }
}

// The floor: a spring to a support that moves with the ground.
function drawSpring(g, [x, y], rest, width, present) {
  if (!present) return;
  const anchor = [width * 0.93, rest[1]];
  const begin = [x, y];
  const points = [begin];
  const turns = 12;
  for (let i = 0; i <= turns; i += 1) {
    const share = 0.12 + (0.76 * i) / turns;
    const side = i === 0 || i === turns ? 0 : (i % 2 ? -7 : 7);
    points.push([begin[0] + (anchor[0] - begin[0]) * share, begin[1] + (anchor[1] - begin[1]) * share + side]);
  }
  points.push(anchor);
  g.strokeStyle = "#888";
  g.lineWidth = 1.5;
  path(g, points);
  g.stroke();
  g.lineWidth = 3;
  path(g, [[anchor[0], anchor[1] - 18], [anchor[0], anchor[1] + 18]]);
  g.stroke();
  dot(g, begin, 4, "#888");
}

function dot(g, [x, y], radius, colour) {
  g.beginPath();
  g.arc(x, y, radius, 0, 2 * Math.PI);
  g.fillStyle = colour;
  g.fill();
}

function burst(g, [x, y], strength, age) {
  const radius = (8 + 34 * Math.sqrt(strength)) * (0.5 + 0.5 * age);
  g.globalAlpha = 1 - age;
  g.strokeStyle = "#e69f00";
  g.lineWidth = 3;
  g.beginPath();
  g.arc(x, y, radius, 0, 2 * Math.PI);
  g.stroke();
  g.fillStyle = "#ffd35a";
  g.globalAlpha = 0.5 * (1 - age);
  g.fill();
  g.globalAlpha = 1;
}

function drawArrow(g, width, height, share) {
  const y = height * 0.95;
  const length = share * width * 0.3;
  g.font = `${Math.max(11, Math.round(width / 38))}px system-ui, sans-serif`;
  g.fillStyle = "#666";
  g.textAlign = "left";
  g.fillText("ground acceleration", width * 0.02, y + 4);
  g.strokeStyle = "#555";
  g.lineWidth = 3;
  path(g, [[width / 2, y], [width / 2 + length, y]]);
  g.stroke();
  if (Math.abs(length) > 4) {
    const head = Math.sign(length) * 8;
    path(g, [[width / 2 + length - head, y - 6], [width / 2 + length, y], [width / 2 + length - head, y + 6]]);
    g.stroke();
  }
}

// What the data say: patterns, rotations and ground acceleration at any time, and where the bodies then are.

function clamp(value, low, high) { return Math.max(low, Math.min(high, value)); }

function patterns(data) {
  const changes = data.patterns;
  const patternAt = (time) => {
    const row = Math.floor(time / data.step + 1e-6);
    let low = 0;
    let high = changes.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (changes[middle][0] <= row) low = middle; else high = middle - 1;
    }
    return changes[low][1];
  };
  return { changes, patternAt };
}

// Rotations are clockwise positive about the corner on the side the body leans to (model: s = +1 right, -1 left).
function posture(data, signs, [theta1, theta2]) {
  const [b, [b1, b2], [h1, h2]] = [data.thickness, data.widths, data.heights];
  const turn = (angle, pivot, to) => ([x, y]) => {
    const [dx, dy] = [x - pivot[0], y - pivot[1]];
    const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
    return [to[0] + dx * cos + dy * sin, to[1] - dx * sin + dy * cos];
  };
  // The strip outside the corners has crushed: the body is cut at an angle there.
  const body = (low, tall, width) => {
    const cut = (b - width) / 2;
    return [[-width / 2, low], [width / 2, low], [b / 2, low + cut], [b / 2, low + tall], [-b / 2, low + tall], [-b / 2, low + cut]];
  };
  const pivot = [(signs[0] * b1) / 2, 0];
  const first = turn(theta1, pivot, pivot);
  const hinge = [(signs[1] * b2) / 2, h1];
  const crack = first(hinge);
  const second = data.cracked ? turn(theta2, hinge, crack) : first;
  return {
    pivot,
    crack,
    lower: body(0, h1, b1).map(first),
    upper: body(h1, h2, b2).map(second),
    top: second([0, h1 + h2]),
    rest: [0, h1 + h2],
  };
}

// Rotations and ground acceleration between samples, and the largest of each for scales.
function readings(data) {
  const rows = data.theta1.length;
  const most = (list, least) => list.reduce((m, v) => Math.max(m, Math.abs(v)), least);
  const theta = (time) => {
    const place = clamp(time / data.step, 0, rows - 1);
    const row = Math.min(Math.floor(place), rows - 2);
    const share = place - row;
    return [data.theta1, data.theta2].map((list) => (list[row] * (1 - share) + list[row + 1] * share) / data.perRad);
  };
  const ground = (time) => {
    const row = Math.floor(time / data.step);
    const [a, b] = [data.ground[row] ?? 0, data.ground[row + 1] ?? 0];
    return (a + (b - a) * (time / data.step - row)) / data.perMS2;
  };
  return {
    rows,
    end: (rows - 1) * data.step,
    theta,
    ground,
    largest: Math.max(most(data.theta1, 1), most(data.theta2, 1)) / data.perRad,
    strongest: most(data.ground, 1) / data.perMS2,
    fastest: data.impacts.reduce((m, impact) => Math.max(m, impact[2]), 1e-12),
    ...patterns(data),
  };
}

"use strict";
// The wall in motion: two rigid bodies turned about the corners in contact, from the history of a run.
(() => {
  const STATES = {
    rest: "rest: both joints closed",
    1: "both joints open, both bodies turn about corners of the same side",
    2: "both joints open, the bodies turn about corners of opposite sides",
    3: "only the ground joint open: the wall rocks as one body",
    4: "only the crack open: the upper body rocks on a standing lower one",
  };
  const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
  const WINDOWS = [["whole run", 0], ["20 s", 20], ["10 s", 10], ["5 s", 5], ["2 s", 2], ["0.5 s", 0.5]];
  const FLASH_S = 0.35; // of the viewer's time
  const INK = "#222";

  for (const root of document.querySelectorAll(".motion")) start(root);

  function start(root) {
    const data = JSON.parse(root.querySelector(".motion-data").textContent);
    const rows = data.theta1.length;
    if (rows < 2) return;
    const end = (rows - 1) * data.step;
    const { changes, patternAt } = patterns(data);
    const largest = Math.max(1, ...[data.theta1, data.theta2].map((list) => list.reduce((m, v) => Math.max(m, Math.abs(v)), 0))) / data.perRad;
    // At first the largest rotation is drawn as a fifth of a radian, or as it is where it is larger.
    const state = { time: 0, playing: false, speed: 0.5, magnification: clamp(0.2 / largest, 1, 200), window: 0, flashes: [] };
    const view = build(root, data);

    function theta(time) {
      const place = clamp(time / data.step, 0, rows - 1);
      const row = Math.min(Math.floor(place), rows - 2);
      const share = place - row;
      const between = (list) => (list[row] * (1 - share) + list[row + 1] * share) / data.perRad;
      return [between(data.theta1), between(data.theta2)];
    }
    const ground = (time) => {
      const row = Math.floor(time / data.step);
      const [a, b] = [data.ground[row] ?? 0, data.ground[row + 1] ?? 0];
      return (a + (b - a) * (time / data.step - row)) / data.perMS2;
    };
    const strongest = data.ground.reduce((m, v) => Math.max(m, Math.abs(v)), 1) / data.perMS2;
    const fastest = data.impacts.reduce((m, impact) => Math.max(m, impact[2]), 1e-12);

    function drawStage() {
      const c = view.stage;
      const { width, height } = fit(c, 1.2);
      const g = c.getContext("2d");
      g.clearRect(0, 0, width, height);
      const tall = data.heights[0] + data.heights[1];
      const scale = Math.min((height * 0.72) / tall, (width * 0.5) / (tall * 0.55));
      const origin = [width / 2, height * 0.86];
      const px = ([x, y]) => [origin[0] + scale * x, origin[1] - scale * y];
      const pattern = patternAt(state.time);
      const signs = data.signs[pattern];
      const turned = theta(state.time).map((angle) => angle * state.magnification);
      const shape = posture(data, signs, turned);
      drawGround(g, width, origin, scale * data.thickness);
      drawSpring(g, px(shape.top), px([shape.rest[0], shape.rest[1]]), width, data.stiffness > 0);
      drawBody(g, shape.lower.map(px), data.bodyColours[0]);
      if (data.cracked) drawBody(g, shape.upper.map(px), data.bodyColours[1]);
      // Corners in contact.
      if (signs[0] !== 0) dot(g, px(shape.pivot), 5, INK);
      if (data.cracked && signs[1] !== 0) dot(g, px(shape.crack), 5, INK);
      for (const flash of state.flashes) {
        const age = (performance.now() - flash.born) / 1000 / FLASH_S;
        if (age >= 1) continue;
        const places = [];
        if (flash.joints & 1) places.push(shape.pivot[0] === 0 ? [0, 0] : shape.pivot);
        if (flash.joints & 2) places.push(shape.crack);
        for (const place of places) burst(g, px(place), flash.strength, age);
      }
      if (data.ground.length > 0) drawArrow(g, width, height, ground(state.time) / strongest);
      if (data.collapse !== null && state.time >= end - data.step) {
        g.fillStyle = "#a50f15";
        g.font = `600 ${Math.round(width / 22)}px system-ui, sans-serif`;
        g.textAlign = "center";
        g.fillText("collapse", width / 2, height * 0.06);
      }
      const name = data.patternNames[pattern];
      view.pattern.textContent = name === "rest" ? "rest" : `pattern ${name}`;
      view.pattern.style.color = name === "rest" ? "#666" : data.patternColours[pattern > 4 ? pattern - 4 : pattern];
      view.meaning.textContent = name === "rest" ? STATES.rest.slice(6) : STATES[name[0]];
      const [r1, r2] = theta(state.time).map((angle, i) => (angle / data.alpha[i]).toFixed(3).replace("-", "−"));
      view.values.textContent = data.cracked ? `θ₁/α₁ = ${r1}, θ₂/α₂ = ${r2}` : `θ/α = ${r1}`;
    }

    function shown() {
      const length = state.window === 0 ? end : Math.min(state.window, end);
      const from = clamp(state.time - length / 2, 0, end - length);
      return [from, from + length];
    }

    function drawStrip() {
      const { width, height } = fit(view.strip, 0.62);
      const g = view.strip.getContext("2d");
      g.clearRect(0, 0, width, height);
      const [from, to] = shown();
      const x = (time) => ((time - from) / (to - from)) * width;
      const parts = [0, 0.5, 0.6, 0.68, 1].map((share) => share * height);
      const first = Math.max(0, Math.floor(from / data.step) - 1);
      const last = Math.min(rows - 1, Math.ceil(to / data.step) + 1);
      const top = Math.max(...data.alpha.map((alpha) => largest / alpha)) || 1;
      curve(g, data.theta1, 1 / data.perRad / data.alpha[0] / top, data.bodyColours[0], [parts[0], parts[1]], first, last, x);
      if (data.cracked) curve(g, data.theta2, 1 / data.perRad / data.alpha[1] / top, data.bodyColours[1], [parts[0], parts[1]], first, last, x);
      changes.forEach(([row, index], i) => {
        const until = changes[i + 1] ? changes[i + 1][0] : rows;
        if (row * data.step > to || until * data.step < from) return;
        g.fillStyle = data.patternColours[index];
        g.fillRect(x(row * data.step), parts[1], Math.max(1, x(until * data.step) - x(row * data.step)), parts[2] - parts[1]);
      });
      g.strokeStyle = INK;
      g.lineWidth = width / 700;
      for (const [time, , rate] of data.impacts) {
        if (time < from || time > to) continue;
        const tall = (0.15 + 0.85 * (rate / fastest)) * (parts[3] - parts[2] - 2);
        g.beginPath();
        g.moveTo(x(time), parts[3]);
        g.lineTo(x(time), parts[3] - tall);
        g.stroke();
      }
      curve(g, data.ground, 1 / data.perMS2 / strongest, "#555", [parts[3], parts[4]], first, Math.min(last, data.ground.length - 1), x);
      labels(g, width, parts, `±${top.toPrecision(2)}`, data.ground.length > 0 ? strongest : 0);
      g.strokeStyle = "#a50f15";
      g.lineWidth = width / 350;
      g.beginPath();
      g.moveTo(x(state.time), 0);
      g.lineTo(x(state.time), height);
      g.stroke();
      view.span.textContent = `${from.toFixed(2)} s to ${to.toFixed(2)} s`;
    }

    function draw() {
      drawStage();
      drawStrip();
      view.scrub.value = String(state.time);
      view.time.textContent = `${state.time.toFixed(3)} s`;
      moveCursors(state.time);
    }

    function go(time, passing) {
      const before = state.time;
      state.time = clamp(time, 0, end);
      if (passing) {
        for (const [at, joints, rate] of data.impacts) {
          if (at > before && at <= state.time) state.flashes.push({ born: performance.now(), joints, strength: rate / fastest });
        }
        state.flashes = state.flashes.filter((flash) => performance.now() - flash.born < FLASH_S * 1000).slice(-40);
      }
      draw();
    }

    let drawn = 0;
    function frame(now) {
      if (!state.playing) return;
      go(state.time + Math.min(0.1, (now - drawn) / 1000) * state.speed, true);
      drawn = now;
      if (state.time >= end) play(false);
      requestAnimationFrame(frame);
    }
    function play(on) {
      if (on && state.time >= end) state.time = 0;
      state.playing = on;
      view.play.textContent = on ? "Pause" : "Play";
      if (on) {
        drawn = performance.now();
        requestAnimationFrame(frame);
      } else fade();
    }
    // After a jump or a pause flashes fade although time stands.
    function fade() {
      if (state.playing || !state.flashes.some((flash) => performance.now() - flash.born < FLASH_S * 1000)) return;
      drawStage();
      requestAnimationFrame(fade);
    }
    function jump(direction) {
      const times = data.impacts.map((impact) => impact[0]);
      const next = direction > 0 ? times.find((t) => t > state.time + 1e-9) : times.findLast((t) => t < state.time - 1e-9);
      if (next === undefined) return;
      play(false);
      state.time = next - 1e-9;
      go(next, true);
      fade();
    }

    view.play.addEventListener("click", () => play(!state.playing));
    view.back.addEventListener("click", () => jump(-1));
    view.next.addEventListener("click", () => jump(1));
    view.peak.addEventListener("click", () => { play(false); go(data.peaks[0], false); });
    view.scrub.max = String(end);
    view.scrub.step = String(data.step);
    view.scrub.addEventListener("input", () => { play(false); go(Number(view.scrub.value), false); });
    view.magnify.value = String(Math.log10(state.magnification));
    const magnified = () => {
      state.magnification = 10 ** Number(view.magnify.value);
      view.magnified.textContent = `× ${state.magnification < 10 ? state.magnification.toFixed(1) : Math.round(state.magnification)}`;
    };
    view.magnify.addEventListener("input", () => { magnified(); draw(); });
    magnified();
    view.speed.value = String(SPEEDS.indexOf(state.speed));
    const sped = () => {
      state.speed = SPEEDS[Number(view.speed.value)];
      view.sped.textContent = `× ${state.speed}`;
    };
    view.speed.addEventListener("input", sped);
    sped();
    view.window.addEventListener("change", () => { state.window = Number(view.window.value); draw(); });
    const drag = (event) => {
      if (event.buttons === 0) return;
      const at = view.strip.getBoundingClientRect();
      const [from, to] = view.held ?? shown();
      play(false);
      go(from + ((event.clientX - at.left) / at.width) * (to - from), false);
    };
    view.strip.addEventListener("pointerdown", (event) => { view.strip.setPointerCapture(event.pointerId); if (state.window === 0) view.held = shown(); drag(event); });
    view.strip.addEventListener("pointermove", (event) => { if (state.window === 0) drag(event); });
    view.strip.addEventListener("pointerup", () => { view.held = undefined; });
    const moveCursors = cursors((time) => { play(false); go(time, false); });
    addEventListener("resize", draw);
    root.classList.add("ready");
    // Begin shortly before the first impact: records begin with seconds of rest.
    state.time = Math.max(0, (data.impacts[0]?.[0] ?? 0) - 0.5);
    draw();
  }

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

  function curve(g, list, scale, colour, [top, bottom], first, last, x) {
    const middle = (top + bottom) / 2;
    const half = ((bottom - top) / 2) * 0.92;
    g.strokeStyle = "#ddd";
    g.lineWidth = 1;
    path(g, [[0, middle], [g.canvas.width, middle]]);
    g.stroke();
    g.beginPath();
    for (let row = first; row <= last; row += 1) {
      const y = middle - list[row] * scale * half;
      if (row === first) g.moveTo(x(row * curve.step), y); else g.lineTo(x(row * curve.step), y);
    }
    g.strokeStyle = colour;
    g.lineWidth = g.canvas.width / 450;
    g.stroke();
  }

  function labels(g, width, parts, rotations, strongest) {
    g.font = `${Math.max(10, Math.round(width / 48))}px system-ui, sans-serif`;
    g.textAlign = "left";
    g.fillStyle = "#666";
    const down = width / 40;
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

  function build(root, data) {
    curve.step = data.step;
    const make = (tag, parent, attributes = {}, text = "") => {
      const element = document.createElement(tag);
      for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
      element.textContent = text;
      parent.append(element);
      return element;
    };
    const left = make("div", root, { class: "stage" });
    const stage = make("canvas", left, { role: "img", "aria-label": "the wall in motion" });
    const right = make("div", root, { class: "controls" });
    const status = make("div", right, { class: "state" });
    const pattern = make("b", status);
    const meaning = make("div", status);
    const values = make("div", status);
    const buttons = make("div", right, { class: "buttons" });
    const button = (text, kind) => make("button", buttons, { type: "button", class: kind }, text);
    const play = button("Play", "play");
    const back = button("◂ impact", "back");
    const next = button("impact ▸", "next");
    const peak = button("largest rotation", "peak");
    const slider = (text, attributes) => {
      const label = make("label", right);
      make("span", label, {}, text);
      const input = make("input", label, { type: "range", ...attributes });
      return [input, make("output", label)];
    };
    const [scrub, time] = slider("time", { min: 0, class: "scrub" });
    const [magnify, magnified] = slider("magnification", { min: 0, max: 2.3, step: 0.01, class: "magnify" });
    const [speed, sped] = slider("speed", { min: 0, max: SPEEDS.length - 1, step: 1, class: "speed" });
    const strip = make("canvas", right, { class: "strip", role: "img", "aria-label": "rotations, patterns, impacts and ground acceleration around the time shown" });
    const keys = make("div", right, { class: "keys" });
    const bodies = data.cracked ? ["lower body", "upper body"] : ["wall"];
    bodies.forEach((name, i) => key(keys, data.bodyColours[i], name));
    data.patternNames.forEach((name, i) => { if (data.patterns.some((change) => change[1] === i)) key(keys, data.patternColours[i], name); });
    const label = make("label", right);
    make("span", label, {}, "shown");
    const select = make("select", label, { class: "window" });
    for (const [text, value] of WINDOWS) make("option", select, { value }, text);
    const span = make("output", label);
    function key(parent, colour, text) {
      const item = make("span", parent);
      make("i", item, { style: `background:${colour}` });
      item.append(text);
    }
    return { stage, strip, pattern, meaning, values, play, back, next, peak, scrub, time, magnify, magnified, speed, sped, window: select, span };
  }
})();

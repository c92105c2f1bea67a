// Playing, pausing, jumping: what time is shown.

function start(root) {
  const data = JSON.parse(root.querySelector(".motion-data").textContent);
  if (data.theta1.length < 2) return;
  const run = readings(data);
  // At first the largest rotation is drawn as a fifth of a radian, or as it is where it is larger.
  const state = { time: 0, playing: false, speed: 0.5, magnification: clamp(0.2 / run.largest, 1, 200), window: 0, flashes: [] };
  const view = build(root, data);
  const moveCursors = cursors((time) => { play(false); go(time); });

  function draw() {
    drawStage(view, data, run, state);
    drawStrip(view, data, run, state);
    view.scrub.value = String(state.time);
    view.time.textContent = `${state.time.toFixed(3)} s`;
    moveCursors(state.time);
  }
  function go(time, passing = false) {
    const before = state.time;
    state.time = clamp(time, 0, run.end);
    if (passing) {
      for (const [at, joints, rate] of data.impacts) {
        if (at > before && at <= state.time) state.flashes.push({ born: performance.now(), joints, strength: rate / run.fastest });
      }
      state.flashes = state.flashes.filter(burning).slice(-40);
    }
    draw();
  }

  let drawn = 0;
  function frame(now) {
    if (!state.playing) return;
    go(state.time + Math.min(0.1, (now - drawn) / 1000) * state.speed, true);
    drawn = now;
    if (state.time >= run.end) play(false);
    requestAnimationFrame(frame);
  }
  function play(on) {
    if (on && state.time >= run.end) state.time = 0;
    state.playing = on;
    view.play.textContent = on ? "Pause" : "Play";
    if (on) {
      drawn = performance.now();
      requestAnimationFrame(frame);
    } else fade();
  }
  // After a jump or a pause flashes fade although time stands.
  function fade() {
    if (state.playing || !state.flashes.some(burning)) return;
    drawStage(view, data, run, state);
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
  view.peak.addEventListener("click", () => { play(false); go(data.peaks[0]); });
  view.scrub.max = String(run.end);
  view.scrub.step = String(data.step);
  view.scrub.addEventListener("input", () => { play(false); go(Number(view.scrub.value)); });
  settings(view, state, draw);
  scrubbing(view, run, state, (time) => { play(false); go(time); });
  addEventListener("resize", draw);
  root.classList.add("ready");
  // Begin shortly before the first impact: records begin with seconds of rest.
  state.time = Math.max(0, (data.impacts[0]?.[0] ?? 0) - 0.5);
  draw();
}

// Magnification, speed and the length of time shown.
function settings(view, state, draw) {
  const magnified = () => {
    state.magnification = 10 ** Number(view.magnify.value);
    view.magnified.textContent = `× ${state.magnification < 10 ? state.magnification.toFixed(1) : Math.round(state.magnification)}`;
  };
  view.magnify.value = String(Math.log10(state.magnification));
  view.magnify.addEventListener("input", () => { magnified(); draw(); });
  magnified();
  const sped = () => {
    state.speed = SPEEDS[Number(view.speed.value)];
    view.sped.textContent = `× ${state.speed}`;
  };
  view.speed.value = String(SPEEDS.indexOf(state.speed));
  view.speed.addEventListener("input", sped);
  sped();
  view.window.addEventListener("change", () => { state.window = Number(view.window.value); draw(); });
}

// A press on the strip sets the time; along the whole run it can be dragged.
function scrubbing(view, run, state, set) {
  let held;
  const drag = (event) => {
    if (event.buttons === 0) return;
    const at = view.strip.getBoundingClientRect();
    const [from, to] = held ?? shown(run, state);
    set(from + ((event.clientX - at.left) / at.width) * (to - from));
  };
  view.strip.addEventListener("pointerdown", (event) => {
    view.strip.setPointerCapture(event.pointerId);
    if (state.window === 0) held = shown(run, state);
    drag(event);
  });
  view.strip.addEventListener("pointermove", (event) => { if (state.window === 0) drag(event); });
  view.strip.addEventListener("pointerup", () => { held = undefined; });
}

for (const root of document.querySelectorAll(".motion")) start(root);

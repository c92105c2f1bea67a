// Buttons, sliders and canvases, made in the place of the animation.

const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
const WINDOWS = [["whole run", 0], ["20 s", 20], ["10 s", 10], ["5 s", 5], ["2 s", 2], ["0.5 s", 0.5]];

function build(root, data) {
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

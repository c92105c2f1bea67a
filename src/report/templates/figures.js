"use strict";
// Values under the pointer, and curves chosen from the legend.
(() => {
  const tip = document.getElementById("tip");
  const show = (circle) => {
    tip.textContent = circle.dataset.tip;
    tip.hidden = false;
    const at = circle.getBoundingClientRect();
    const left = at.left + at.width / 2 - tip.offsetWidth / 2;
    const widest = document.documentElement.clientWidth - tip.offsetWidth - 4;
    const above = at.top - tip.offsetHeight - 6;
    tip.style.left = `${Math.max(4, Math.min(left, widest)) + scrollX}px`;
    tip.style.top = `${(above > 0 ? above : at.bottom + 6) + scrollY}px`;
  };
  for (const circle of document.querySelectorAll(".hits circle")) {
    // The element's own title would come up a second time.
    const title = circle.querySelector("title");
    circle.dataset.tip = title.textContent;
    title.remove();
    circle.addEventListener("pointerenter", () => show(circle));
    circle.addEventListener("pointerdown", () => show(circle));
    circle.addEventListener("pointerleave", () => { tip.hidden = true; });
  }
  // A frame that is wider than the screen fades at its edge as long as there is more to come.
  for (const frame of document.querySelectorAll(".panels.wide, .table")) {
    const update = () => frame.classList.toggle("more", frame.scrollLeft + frame.clientWidth < frame.scrollWidth - 2);
    frame.addEventListener("scroll", update, { passive: true });
    addEventListener("resize", update);
    update();
  }
  const coloursOf = (element) =>
    [element.getAttribute("stroke"), element.getAttribute("fill"), element.dataset.colour];
  for (const figure of document.querySelectorAll("figure.plot")) {
    const keys = [...figure.querySelectorAll(".legend button")];
    const all = new Set(keys.map((key) => key.dataset.colour));
    const update = () => {
      const chosen = new Set(keys.filter((key) => key.getAttribute("aria-pressed") === "true").map((key) => key.dataset.colour));
      for (const element of figure.querySelectorAll(".panel svg *")) {
        const own = coloursOf(element).find((colour) => all.has(colour));
        if (own) element.classList.toggle("faded", chosen.size > 0 && !chosen.has(own));
      }
    };
    for (const key of keys) {
      key.addEventListener("click", () => {
        key.setAttribute("aria-pressed", String(key.getAttribute("aria-pressed") !== "true"));
        update();
      });
    }
  }
})();

// What is wrong with the labels of a page's map: outside of it, on each other, or wider than their pills.
() => {
  const box = (element) => element.getBoundingClientRect();
  const inside = (a, b) => a.left >= b.left && a.right <= b.right && a.top >= b.top && a.bottom <= b.bottom;
  const beside = (a, b) => a.right <= b.left + 1 || a.bottom <= b.top + 1;
  const map = box(document.getElementById("map"));
  const tokens = [...document.querySelectorAll("[data-token]")].filter((e) => e.style.display !== "none");
  const wrong = tokens.filter((e) => !inside(box(e), map)).map((e) => `${e.dataset.token} outside`);
  const labels = tokens.filter((e) => e.querySelector("text"));
  const outline = (e) => box(e.querySelector("rect, circle"));
  for (const one of labels) {
    const a = outline(one);
    const text = box(one.querySelector("text"));
    if (text.left < a.left || text.right > a.right) wrong.push(`${one.dataset.token} spills`);
    for (const other of labels) {
      const b = outline(other);
      if (one !== other && !beside(a, b) && !beside(b, a)) wrong.push(`${one.dataset.token} on ${other.dataset.token}`);
    }
  }
  return wrong;
}

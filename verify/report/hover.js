// Names what lies under the pointer.
export function nameOnHover(stage, view) {
  const tooltip = document.getElementById('tooltip');
  const hide = () => { tooltip.hidden = true; };
  const name = (event) => {
    const box = stage.getBoundingClientRect();
    const x = event.clientX - box.left, y = event.clientY - box.top;
    const hit = event.target === view.element ? view.pick(x, y) : null;
    if (!hit) return hide();
    const detail = document.createElement('small');
    detail.textContent = [hit.kind, hit.detail].filter(Boolean).join(', ');
    tooltip.replaceChildren(document.createTextNode(hit.title), detail);
    tooltip.hidden = false;
    tooltip.style.left = Math.min(x + 14, Math.max(0, box.width - tooltip.offsetWidth - 6)) + 'px';
    tooltip.style.top = Math.min(y + 14, Math.max(0, box.height - tooltip.offsetHeight - 6)) + 'px';
  };
  let waiting = null;
  stage.addEventListener('pointermove', (event) => {
    if (event.buttons) return hide();
    if (!waiting) requestAnimationFrame(() => { name(waiting); waiting = null; });
    waiting = event;
  });
  stage.addEventListener('pointerdown', (event) => event.pointerType === 'touch' ? name(event) : hide());
  stage.addEventListener('pointerleave', hide);
}

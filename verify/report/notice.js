// A line of small print in the corner of the drawing.
export function addNotice(stage, text) {
  const notice = document.createElement('p');
  notice.className = 'notice';
  notice.textContent = text;
  stage.appendChild(notice);
}

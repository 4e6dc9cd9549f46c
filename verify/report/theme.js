// Colours come from the style sheet, so that light and dark are decided in one place.
const NAMES = ['paper', 'panel', 'ink', 'muted', 'line', 'accent', 'holds', 'fails', 'undecided',
  'margin', 'clearance', 'robot', 'robot-edge', 'object', 'object-edge', 'floor', 'grid', 'com',
  'contact', 'trail'];

export function readTheme() {
  const style = getComputedStyle(document.documentElement);
  const theme = {dark: matchMedia('(prefers-color-scheme: dark)').matches};
  for (const name of NAMES) {
    theme[name.replace(/-(.)/, (_, c) => c.toUpperCase())] = style.getPropertyValue('--' + name).trim();
  }
  return theme;
}

export function onThemeChange(call) {
  const query = matchMedia('(prefers-color-scheme: dark)');
  if (query.addEventListener) query.addEventListener('change', call); else query.addListener(call);
}

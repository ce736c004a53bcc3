// The theme that was chosen, before anything is painted.
try {
  const theme = localStorage.getItem("whichone.theme");
  if (theme === "light" || theme === "dark") document.documentElement.dataset.theme = theme;
} catch {
  // Storage is refused in some private windows: the system's theme it is.
}

// The look that was chosen (see settings/look.js), before anything is painted.
try {
  for (const name of ["theme", "text", "motion"]) {
    const value = localStorage.getItem(`whichone.${name}`);
    if (value !== null) document.documentElement.dataset[name] = value;
  }
} catch {
  // Storage is refused in some private windows: the system's look it is.
}

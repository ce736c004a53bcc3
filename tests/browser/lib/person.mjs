// A truthful user who knows the desired object.

/**
 * The true answer to a question about the wanted object.
 * @param {{type: string, object?: string, attribute?: string, value?: string}} question
 * @param {{name: string, attributes: Record<string, string>}} wanted
 */
export function answer(question, wanted) {
  const value = wanted.attributes[question.attribute ?? ""];
  switch (question.type) {
    case "point":
      return question.object === wanted.name ? "yes" : "no";
    case "attr":
      return question.value === value ? "yes" : "no";
    case "which":
      return value ?? "I don't know";
    default:
      return `the ${Object.values(wanted.attributes).join(" ")} one`;
  }
}

// The two systems of units, and the texts that people and the server read.

export type System = "imperial" | "metric";
export type Quantity = "speed" | "length" | "angle" | "spin" | "short";

const FOOT = 0.3048;

const UNITS: Record<Quantity, Record<System, { name: string; size: number }>> = {
  speed: { imperial: { name: "ft/s", size: FOOT }, metric: { name: "m/s", size: 1 } },
  length: { imperial: { name: "ft", size: FOOT }, metric: { name: "m", size: 1 } },
  angle: { imperial: { name: "deg", size: 1 }, metric: { name: "deg", size: 1 } },
  spin: { imperial: { name: "rev/s", size: 1 }, metric: { name: "rev/s", size: 1 } },
  short: { imperial: { name: "in", size: FOOT / 12 }, metric: { name: "cm", size: 0.01 } },
};

export const unit = (quantity: Quantity, system: System) => UNITS[quantity][system].name;

/** A number in one system, in the other, with so many decimals. */
export function converted(value: number, quantity: Quantity, from: System, to: System): number {
  const units = UNITS[quantity];
  // Six decimals: there and back is the same number.
  return Number(((value * units[from].size) / units[to].size).toFixed(6));
}

export const inSystem = (metres: number, quantity: Quantity, system: System) => metres / UNITS[quantity][system].size;

/** A value as the server takes it: `24.4 ft/s`. */
export const text = (value: number, quantity: Quantity, system: System) => `${value} ${unit(quantity, system)}`;

/** Makes per 100: a whole number while it is rough, a decimal when it is sharp. */
export const per100 = (probability: number, decimals = 1) => (100 * probability).toFixed(decimals);

/** A difference in makes per 100, with its sign. */
export function signed(difference: number, decimals = 1): string {
  const number = (100 * difference).toFixed(decimals);
  return Number(number) === 0 ? (0).toFixed(decimals) : difference > 0 ? `+${number}` : number.replace("-", "\u2212");
}

/** The value of a key of an answer, whatever the unit at its end: `speed` of `speed_ft_s`. */
export function valueOf(object: Record<string, unknown>, name: string): number | undefined {
  const key = Object.keys(object).find((key) => key.startsWith(`${name}_`) || key === name);
  const value = key === undefined ? undefined : object[key];
  return typeof value === "number" ? value : undefined;
}

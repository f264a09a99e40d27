// Half a court from above: to choose a place on, or coloured by the results of a sweep.

import type { TargetedMouseEvent } from "preact";
import type { CourtLines } from "./api";

export interface MapPlace {
  x: number;
  y: number;
  colour: string;
  label: string;
}

interface Props {
  court: CourtLines;
  /** The chosen place, m. */
  chosen?: { x: number; y: number } | undefined;
  places?: MapPlace[];
  /** Side of a coloured square, m. */
  step?: number;
  label: string;
  onChoose: (x: number, y: number) => void;
}

/** On the page the shooter faces the hoop, which is at the top; right is right. */
export function CourtMap({ court, chosen, places = [], step = 0.9, label, onChoose }: Props) {
  const wide = court.half_width_m;
  const far = Math.min(court.half_line_x_m, 12.2);
  const base = court.baseline_x_m;
  const turn = Math.atan2(court.three_corner_y_m, court.three_break_x_m);
  const r3 = court.three_radius_m;
  const [bx, by] = [r3 * Math.cos(turn), r3 * Math.sin(turn)];
  const lane = court.lane_half_width_m;
  const ft = court.free_throw_x_m;
  const lines = [
    `M ${-wide} ${far} V ${base} H ${wide} V ${far} Z`,
    `M ${-lane} ${base} V ${ft} H ${lane} V ${base}`,
    `M ${-court.circle_radius_m} ${ft} A ${court.circle_radius_m} ${court.circle_radius_m} 0 0 0 ${court.circle_radius_m} ${ft}`,
    `M ${-by} ${base} V ${bx} A ${r3} ${r3} 0 0 0 ${by} ${bx} V ${base}`,
    `M -0.915 -1.22 H 0.915`,
  ];
  const click = (event: TargetedMouseEvent<SVGSVGElement>) => {
    const svg = event.currentTarget;
    const matrix = svg.getScreenCTM();
    if (!matrix) return;
    const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
    onChoose(point.y, point.x);
  };
  return (
    <svg class="court-map" viewBox={`${-wide - 0.2} ${base - 0.2} ${2 * wide + 0.4} ${far - base + 0.4}`} role="img" aria-label={label} onClick={click}>
      <rect class="floor" x={-wide} y={base} width={2 * wide} height={far - base} />
      {places.map((place) => (
        <rect key={`${place.x} ${place.y}`} x={place.y - step / 2} y={place.x - step / 2} width={step} height={step} fill={place.colour}>
          <title>{place.label}</title>
        </rect>
      ))}
      {lines.map((line) => (
        <path key={line} class="court-line" d={line} />
      ))}
      <circle class="hoop" cx={0} cy={0} r={0.2286} />
      {chosen && <circle class="chosen" cx={chosen.y} cy={chosen.x} r={0.3} />}
    </svg>
  );
}

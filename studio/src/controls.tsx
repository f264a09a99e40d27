// The controls that all pages share.

import type { ComponentChildren } from "preact";
import { useId, useState } from "preact/hooks";

interface SliderProps {
  label: string;
  unit: string;
  value: number;
  min: number;
  max: number;
  step: number;
  error?: string | undefined;
  onChange: (value: number) => void;
}

/** A slider with the number beside it, for the mouse and for exact values. */
export function Slider({ label, unit, value, min, max, step, error, onChange }: SliderProps) {
  const id = useId();
  const [isEmpty, setEmpty] = useState(false);
  const change = (text: string) => {
    const number = Number(text);
    const isNumber = text !== "" && Number.isFinite(number);
    setEmpty(!isNumber);
    if (isNumber) onChange(number);
  };
  const problem = isEmpty ? "type a number; until then the last one counts" : error;
  return (
    <div class={problem ? "slider wrong" : "slider"}>
      <label for={id}>{label}</label>
      <input id={id} type="range" min={min} max={max} step={step} value={value} onInput={(event) => change(event.currentTarget.value)} />
      <span class="number">
        <input type="number" aria-label={`${label}, ${unit}`} step={step} value={value} onInput={(event) => change(event.currentTarget.value)} />
        <span class="unit">{unit}</span>
      </span>
      {problem && (
        <p class="error" role="alert">
          {problem}
        </p>
      )}
    </div>
  );
}

interface FieldProps {
  label: string;
  error?: string | undefined;
  help?: string | undefined;
  children: (id: string) => ComponentChildren;
}

function Field({ label, error, help, children }: FieldProps) {
  const id = useId();
  return (
    <div class={error ? "field wrong" : "field"}>
      <label for={id}>{label}</label>
      {children(id)}
      {help && <p class="help">{help}</p>}
      {error && (
        <p class="error" role="alert">
          {error}
        </p>
      )}
    </div>
  );
}

interface TextProps {
  label: string;
  value: string;
  placeholder?: string;
  error?: string | undefined;
  help?: string;
  onChange: (value: string) => void;
}

export function TextField({ label, value, placeholder, error, help, onChange }: TextProps) {
  return (
    <Field label={label} error={error} help={help}>
      {(id) => <input id={id} type="text" value={value} placeholder={placeholder ?? ""} onInput={(event) => onChange(event.currentTarget.value)} />}
    </Field>
  );
}

interface ChoiceProps {
  label: string;
  value: string;
  options: readonly (readonly [string, string])[];
  error?: string | undefined;
  onChange: (value: string) => void;
}

export function Choice({ label, value, options, error, onChange }: ChoiceProps) {
  return (
    <Field label={label} error={error}>
      {(id) => (
        <select id={id} value={value} onChange={(event) => onChange(event.currentTarget.value)}>
          {options.map(([key, words]) => (
            <option key={key} value={key}>
              {words}
            </option>
          ))}
        </select>
      )}
    </Field>
  );
}

export function Tick({ label, value, onChange }: { label: string; value: boolean; onChange: (value: boolean) => void }) {
  return (
    <label class="tick">
      <input type="checkbox" checked={value} onChange={(event) => onChange(event.currentTarget.checked)} /> {label}
    </label>
  );
}

/** Text that a button puts on the clipboard. */
export function CopyButton({ words, text }: { words: string; text: () => string | Promise<string> }) {
  const copy = async (button: HTMLButtonElement) => {
    try {
      await navigator.clipboard.writeText(await text());
      button.dataset.copied = "yes";
    } catch {
      button.dataset.copied = "no";
    }
    setTimeout(() => delete button.dataset.copied, 1500);
  };
  return (
    <button type="button" class="quiet" onClick={(event) => void copy(event.currentTarget)}>
      {words}
    </button>
  );
}

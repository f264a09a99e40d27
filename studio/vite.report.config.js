import { defineConfig } from "vite";

// The script of the reports: one file that stands inside the page.
export default defineConfig({
  build: {
    target: "es2022",
    emptyOutDir: false,
    chunkSizeWarningLimit: 1500,
    lib: { entry: "src/report.ts", formats: ["iife"], name: "report", fileName: () => "report.js" },
  },
});

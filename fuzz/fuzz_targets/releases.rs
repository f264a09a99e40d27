//! Releases as text: records, columns, values, one simulated shot each.
#![no_main]

use bankshot::dynamics::Simulator;
use bankshot::files::csv_records::MAX_RECORD_BYTES;
use bankshot::files::table_rows::TableRows;
use bankshot::model::Physics;
use bankshot::present::simulation_files::release_columns::ReleaseColumns;
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static SIMULATOR: LazyLock<Simulator> =
    LazyLock::new(|| Simulator::new(&Physics::paper()).unwrap());

fuzz_target!(|bytes: &[u8]| {
    let Ok(mut rows) = TableRows::of_stream(Box::new(std::io::Cursor::new(bytes.to_vec()))) else {
        return;
    };
    let header = rows.header().clone();
    let Ok(columns) = ReleaseColumns::new(&header, &[]) else {
        return;
    };
    while let Ok(batch) = rows.next_rows(16, MAX_RECORD_BYTES) {
        if batch.is_empty() {
            break;
        }
        for cells in batch.into_iter().filter_map(|row| row.cells.ok()) {
            if let Ok(release) = columns.release(&cells, SIMULATOR.physics()) {
                let outcome = SIMULATOR.simulate(&release).unwrap();
                assert!(outcome.verdict.time_s.is_finite());
            }
        }
    }
});

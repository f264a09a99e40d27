//! Records of numbers and truth values that are kept in lanes.

use super::real::Real;

/// A record whose fields are numbers and truth values: those of one shot, or of one in each lane.
///
/// Its fields are named one by one, not in a loop: then they stay in registers.
pub(crate) trait RealRecord<T: Real>: Copy {
    /// From its numbers and truth values in order.
    fn read(from: &mut impl RecordReader<T>) -> Self;
    /// Writes its numbers and truth values in order.
    fn write(&self, to: &mut impl RecordWriter<T>);
}

/// Where a record comes from.
pub(crate) trait RecordReader<T: Real> {
    /// The next number.
    fn number(&mut self) -> T;
    /// The next truth value.
    fn truth(&mut self) -> T::Mask;
}

/// Where a record goes.
pub(crate) trait RecordWriter<T: Real> {
    /// The next number.
    fn number(&mut self, number: T);
    /// The next truth value.
    fn truth(&mut self, truth: T::Mask);
}

/// The numbers and the truth values that a record writes.
#[cfg(test)]
pub(crate) fn counts(record: &impl RealRecord<f64>) -> (usize, usize) {
    struct Counter(usize, usize);
    impl RecordWriter<f64> for Counter {
        fn number(&mut self, _: f64) {
            self.0 += 1;
        }

        fn truth(&mut self, _: bool) {
            self.1 += 1;
        }
    }
    let mut counter = Counter(0, 0);
    record.write(&mut counter);
    (counter.0, counter.1)
}

//! Effects: outputs and records that a node requests.

/// Effects of one or more events, in the order in which they were stated.
#[derive(Clone, Debug, PartialEq)]
pub struct Effects<Out, Record> {
    records: Vec<Record>,
    outputs: Vec<Out>,
    exit: bool,
}

impl<Out, Record> Default for Effects<Out, Record> {
    fn default() -> Self {
        Self { records: Vec::new(), outputs: Vec::new(), exit: false }
    }
}

impl<Out, Record> Effects<Out, Record> {
    /// Appends `record` to the journal before anything of this batch is published.
    pub fn append(&mut self, record: Record) {
        self.records.push(record);
    }

    /// Publishes `output` once every record of this batch is durable.
    pub fn publish(&mut self, output: Out) {
        self.outputs.push(output);
    }

    /// Ends the service after this batch.
    pub fn exit(&mut self) {
        self.exit = true;
    }

    /// Returns true if the service is to end.
    pub fn exits(&self) -> bool {
        self.exit
    }

    /// Takes the records, leaving none.
    pub fn take_records(&mut self) -> Vec<Record> {
        std::mem::take(&mut self.records)
    }

    /// Takes the outputs, leaving none.
    pub fn take_outputs(&mut self) -> Vec<Out> {
        std::mem::take(&mut self.outputs)
    }
}

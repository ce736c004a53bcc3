//! An attribute, as a partition of the classes.

use scene::{AttributeId, ObjectId, ValueId};

use super::channel::Channel;
use crate::{DecisionProblem, Model, OpenQuestion};

/// An attribute that tells classes apart: those of one cell have the same value.
#[derive(Debug)]
pub(crate) struct Column {
    pub(crate) attribute: AttributeId,
    /// The cell of every class.
    pub(crate) cells: Vec<u16>,
    /// The value of every cell; `None` for the cell of classes that lack the attribute.
    pub(crate) values: Vec<Option<ValueId>>,
    /// How "is its k v?" is answered.
    pub(crate) yes_no: Channel,
    /// How "what is its k?" is answered.
    pub(crate) open: Channel,
}

impl Column {
    /// The partition that an attribute makes of classes, of each of which one object is given;
    /// none if it tells nothing apart.
    pub(super) fn of(
        problem: &DecisionProblem<'_>,
        k: AttributeId,
        classes: &[ObjectId],
    ) -> Option<Self> {
        let model = problem.model;
        let mut cell_of = vec![None; model.values(k) + 1];
        let mut values = Vec::new();
        let mut cells = Vec::with_capacity(classes.len());
        for object in classes {
            let entry = model.column(k)[object.index()];
            // Objects that lack the attribute take the place after the last value.
            let place = usize::from(entry).min(model.values(k));
            let cell = *cell_of[place].get_or_insert_with(|| {
                values.push((entry != Model::LACKS).then_some(ValueId(entry)));
                (values.len() - 1) as u16
            });
            cells.push(cell);
        }
        if values.len() < 2 {
            return None;
        }
        let lacking = values.contains(&None);
        let named = values.len() - usize::from(lacking);
        let absent = model.values(k) - named;
        let open = Channel::open(problem, OpenQuestion::new(model, k), named, absent, lacking);
        let yes_no = Channel::yes_no(model.params(), &problem.costs, problem.costs.attribute_s);
        Some(Self { attribute: k, cells, values, yes_no, open })
    }

    /// The cell of classes that lack the attribute.
    pub(super) fn lacking(&self) -> Option<usize> {
        self.values.iter().position(Option::is_none)
    }

    /// Every value's cell, with the exclusive or of its classes' codes.
    pub(super) fn sets(&self, codes: &[u64]) -> impl Iterator<Item = (u16, u64)> {
        let mut sets = vec![0; self.values.len()];
        for (cell, code) in self.cells.iter().zip(codes) {
            sets[usize::from(*cell)] ^= code;
        }
        let valued = self.values.iter().zip(sets).enumerate().filter(|(_, (v, _))| v.is_some());
        valued.map(|(cell, (_, set))| (cell as u16, set))
    }

    /// Whether its open question tells anything: not if there is one value to name.
    pub(super) fn tells(&self) -> bool {
        self.open.capacity > 0.0
    }

    /// Whether its open question has the same answers as a yes/no question.
    pub(super) fn is_yes_no(&self) -> bool {
        self.values.len() == 2 && self.lacking().is_none() && self.open.own == self.yes_no.own
    }

    /// Equal for columns whose open questions have the same answers for every class.
    pub(super) fn identity(&self) -> (Vec<u16>, Option<usize>, [u64; 2]) {
        let answers = [self.open.other.to_bits(), self.open.absent_other.to_bits()];
        (self.cells.clone(), self.lacking(), answers)
    }
}

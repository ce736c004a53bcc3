//! Index newtypes. All of them are positions in the scene's own order, so they are dense and
//! cheap, and mean nothing outside the scene that they came from.

macro_rules! index {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash,
            serde::Serialize, serde::Deserialize,
        )]
        pub struct $name(pub u16);

        impl $name {
            /// The position as a slice index.
            pub fn index(self) -> usize {
                usize::from(self.0)
            }
        }

        impl From<usize> for $name {
            /// # Panics
            /// Above 65,535: [`Scene`](crate::Scene) refuses to be that large.
            fn from(index: usize) -> Self {
                Self(u16::try_from(index).expect("scene indices fit into 16 bits"))
            }
        }
    };
}

index! {
    /// An object `i ∈ I`, in the scene file's order.
    ObjectId
}
index! {
    /// An attribute `k ∈ K`, in the scene file's order.
    AttributeId
}
index! {
    /// A value `v ∈ V_k`: its position in attribute `k`'s own list.
    ValueId
}
index! {
    /// A member of `V = ∪ V_k`. `V` is a set: the same value of two attributes is one word.
    WordId
}

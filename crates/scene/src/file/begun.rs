//! A table whose first name was looked at, and is there for whoever reads it.

use serde::de::value::StringDeserializer;
use serde::de::{DeserializeSeed, IntoDeserializer, MapAccess};

/// A table with its first name, unless it is empty.
pub struct Begun<A> {
    first: Option<String>,
    rest: A,
}

impl<'de, A: MapAccess<'de>> Begun<A> {
    /// A table that nothing was taken of.
    pub fn of(mut rest: A) -> Result<Self, A::Error> {
        Ok(Begun { first: rest.next_key()?, rest })
    }

    /// Whether one of these names stands first.
    pub fn begins_with_one_of(&self, names: &[&str]) -> bool {
        self.first.as_ref().is_some_and(|first| names.contains(&first.as_str()))
    }
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for Begun<A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, A::Error> {
        match self.first.take() {
            Some(first) => {
                let first: StringDeserializer<A::Error> = first.into_deserializer();
                seed.deserialize(first).map(Some)
            }
            None => self.rest.next_key_seed(seed),
        }
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, A::Error> {
        self.rest.next_value_seed(seed)
    }
}

//! A list of errors.

use std::error::Error;
use std::fmt;
use std::ops::Deref;

/// All errors that a check found, in the order in which it found them. It is never empty where a function
/// returns it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Errors<E>(Vec<E>);

impl<E> Errors<E> {
    /// `Ok` if there are no errors, otherwise all of them.
    ///
    /// # Errors
    /// The given errors, if there are any.
    pub fn check(errors: Vec<E>) -> Result<(), Self> {
        if errors.is_empty() { Ok(()) } else { Err(Self(errors)) }
    }
}

impl<E> From<E> for Errors<E> {
    fn from(error: E) -> Self {
        Self(vec![error])
    }
}

impl<E> Deref for Errors<E> {
    type Target = [E];

    fn deref(&self) -> &[E] {
        &self.0
    }
}

impl<E> IntoIterator for Errors<E> {
    type Item = E;
    type IntoIter = std::vec::IntoIter<E>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

/// One line per error.
impl<E: fmt::Display> fmt::Display for Errors<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, error) in self.0.iter().enumerate() {
            if index > 0 {
                f.write_str("\n")?;
            }
            write!(f, "{error}")?;
        }
        Ok(())
    }
}

impl<E: fmt::Debug + fmt::Display> Error for Errors<E> {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_errors_are_success_and_some_are_shown_line_by_line() {
        assert_eq!(Errors::<String>::check(Vec::new()), Ok(()));
        let errors = Errors::check(vec!["one", "two"]).expect_err("two errors");
        assert_eq!(errors.to_string(), "one\ntwo");
        assert_eq!(errors.len(), 2);
    }

    #[test]
    fn the_list_works_with_the_question_mark() {
        fn refuse() -> Result<(), Box<dyn Error>> {
            Ok(Errors::check(vec!["wrong".to_owned()])?)
        }
        assert_eq!(refuse().expect_err("refused").to_string(), "wrong");
    }
}

//! Errors of a device: answered at once by a native one, filed until somebody asks in a page.

use std::fmt;
use std::future::Future;
use std::pin::Pin;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Waker};

use crate::GpuError;

/// Refusals of a device, and answers that are still on their way. No call waits for them.
#[derive(Debug, Default)]
pub(super) struct Errors {
    filed: Mutex<Filed>,
}

#[derive(Debug, Default)]
struct Filed {
    /// Why the device is gone, once it is.
    lost: Option<String>,
    /// The first refusal that was not reported yet.
    first: Option<Refusal>,
    /// Answers on their way.
    asked: Vec<Asked>,
}

/// A refusal without the name of its adapter.
#[derive(Debug)]
pub(super) struct Refusal {
    /// The request.
    what: String,
    /// Words of the device; `None` where it has no memory left.
    message: Option<String>,
}

/// The answer of an error scope.
type Answer = Pin<Box<dyn Future<Output = Option<wgpu::Error>> + Send>>;

struct Asked {
    what: String,
    answer: Answer,
}

impl fmt::Debug for Asked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Asked").field(&self.what).finish()
    }
}

impl Refusal {
    pub fn new(what: &str, error: &wgpu::Error) -> Self {
        let message = match error {
            wgpu::Error::OutOfMemory { .. } => None,
            other => Some(other.to_string()),
        };
        Self { what: what.to_owned(), message }
    }

    pub fn on(self, adapter: String) -> GpuError {
        let what = self.what;
        match self.message {
            None => GpuError::OutOfMemory { adapter, what, bytes: 0 },
            Some(message) => GpuError::Refused { adapter, what, message },
        }
    }
}

impl Errors {
    fn lock(&self) -> MutexGuard<'_, Filed> {
        self.filed.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Notes that the device is gone; the first reason stays.
    pub fn lose(&self, reason: String) {
        self.lock().lost.get_or_insert(reason);
    }

    /// Why the device is gone, once it is.
    pub fn lost(&self) -> Option<String> {
        self.lock().lost.clone()
    }

    /// Files a refusal; the first one is reported.
    pub fn file(&self, refusal: Refusal) {
        self.lock().first.get_or_insert(refusal);
    }

    /// Files answers that are on their way.
    pub fn file_answers(&self, what: &str, answers: impl IntoIterator<Item = Answer>) {
        self.lock().asked.extend(answers.into_iter().map(|answer| Asked { what: what.to_owned(), answer }));
    }

    /// The first refusal that was not reported yet, among those that have arrived.
    pub fn take(&self) -> Option<Refusal> {
        let mut filed = self.lock();
        let Filed { first, asked, .. } = &mut *filed;
        asked.retain_mut(|Asked { what, answer }| match now(answer.as_mut()) {
            Some(error) => {
                let refusal = error.map(|error| Refusal::new(what, &error));
                refusal.into_iter().for_each(|refusal| _ = first.get_or_insert(refusal));
                false
            }
            None => true,
        });
        first.take()
    }
}

/// The answer of an error scope if it has arrived, else its future.
pub(super) fn answered(
    answer: impl Future<Output = Option<wgpu::Error>> + Send + 'static,
) -> Result<Option<wgpu::Error>, Answer> {
    let mut answer: Answer = Box::pin(answer);
    now(answer.as_mut()).ok_or(answer)
}

/// The output of a future that is ready. A native system answers all requests of this kit at once.
pub(super) fn now<F: Future + ?Sized>(future: Pin<&mut F>) -> Option<F::Output> {
    match future.poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(output) => Some(output),
        Poll::Pending => None,
    }
}

#[cfg(test)]
mod tests {
    use std::future::{pending, ready};

    use super::*;

    fn validation(description: &str) -> wgpu::Error {
        let source: Box<dyn std::error::Error + Send + Sync> = description.into();
        wgpu::Error::Validation { source, description: description.to_owned() }
    }

    /// An answer that arrives at its second poll.
    struct Later(Option<wgpu::Error>, bool);

    impl Future for Later {
        type Output = Option<wgpu::Error>;

        fn poll(mut self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<Self::Output> {
            if std::mem::replace(&mut self.1, true) { Poll::Ready(self.0.take()) } else { Poll::Pending }
        }
    }

    #[test]
    fn an_answer_that_comes_later_is_filed_under_its_name_and_reported_once() {
        let errors = Errors::default();
        assert!(matches!(answered(ready(None)), Ok(None)));
        let late = answered(Later(Some(validation("too wide")), false)).err().unwrap();
        let never = answered(pending()).err().unwrap();
        errors.file_answers("a texture", [never, late]);
        let error = errors.take().unwrap().on("adapter".to_owned());
        assert_eq!(error.to_string(), "adapter: a texture: too wide");
        assert!(errors.take().is_none());
        let source: Box<dyn std::error::Error + Send + Sync> = "none".into();
        errors.file(Refusal::new("a buffer", &wgpu::Error::OutOfMemory { source }));
        errors.file(Refusal::new("a step", &validation("wrong")));
        let first = errors.take().unwrap().on(String::new());
        assert!(matches!(first, GpuError::OutOfMemory { what, .. } if what == "a buffer"));
        errors.lose("gone".to_owned());
        errors.lose("again".to_owned());
        assert_eq!(errors.lost().as_deref(), Some("gone"));
    }
}

//! How jobs reach tasks and answers come back, on one thread.
//!
//! An actor has one job at a time, so its mailbox holds one letter, and fits with its task's waker into a cache line. A channel
//! holds any number and is made for threads: it reads several lines a letter, which at 20,480 robots was half of what actors cost
//! beyond direct calls.

use std::cell::{Cell, RefCell};
use std::future::poll_fn;
use std::task::{Context, Poll, Waker};

/// Room for one letter, and for the task that waits for it.
pub struct Mailbox<L> {
    letter: Cell<Option<L>>,
    reader: Bell,
}

impl<L> Default for Mailbox<L> {
    fn default() -> Self {
        Self {
            letter: Cell::new(None),
            reader: Bell::default(),
        }
    }
}

impl<L> Mailbox<L> {
    /// Puts in `letter`, and wakes the reader.
    pub fn put(&self, letter: L) {
        let unread = self.letter.replace(Some(letter));
        debug_assert!(unread.is_none(), "an actor has one job at a time");
        self.reader.ring();
    }

    /// Wakes the reader without a letter, for it to see that the post has closed.
    pub fn wake(&self) {
        self.reader.ring();
    }

    /// Takes out the letter, if there is one.
    pub fn take(&self) -> Option<L> {
        self.letter.take()
    }

    /// Has the present task woken by the next letter.
    pub fn wait<T>(&self, context: &Context<'_>) -> Poll<T> {
        self.reader.wait(context)
    }
}

/// Where the answers of one round are put, each in its place, and the driver waits for all of them.
pub struct Desk<A> {
    answers: RefCell<Vec<Option<A>>>,
    missing: Cell<usize>,
    driver: Bell,
    panicked: Cell<bool>,
    closed: Cell<bool>,
}

impl<A> Default for Desk<A> {
    fn default() -> Self {
        Self {
            answers: RefCell::default(),
            missing: Cell::new(0),
            driver: Bell::default(),
            panicked: Cell::new(false),
            closed: Cell::new(false),
        }
    }
}

impl<A> Desk<A> {
    /// Makes room for a round of `count` answers.
    pub fn clear(&self, count: usize) {
        let mut answers = self.answers.borrow_mut();
        answers.clear();
        answers.resize_with(count, || None);
        self.missing.set(count);
    }

    /// Puts `answer` in its place. The last one wakes the driver.
    pub fn put(&self, place: usize, answer: A) {
        self.answers.borrow_mut()[place] = Some(answer);
        self.missing.set(self.missing.get() - 1);
        if self.missing.get() == 0 {
            self.driver.ring();
        }
    }

    /// Waits until every answer is there.
    ///
    /// # Panics
    /// If a task panicked that has [given notice](Self::notice_of_panic): its answer never comes.
    pub async fn complete(&self) {
        poll_fn(|context| {
            assert!(!self.panicked.get(), "an actor panicked");
            if self.missing.get() == 0 {
                return Poll::Ready(());
            }
            self.driver.wait(context)
        })
        .await;
    }

    /// Moves the answers out, in the order of their places.
    pub fn take(&self, into: &mut Vec<A>) {
        into.extend(self.answers.borrow_mut().drain(..).flatten());
    }

    /// There is no round any more.
    pub fn close(&self) {
        self.closed.set(true);
    }

    /// Whether there is no round any more.
    pub fn is_closed(&self) -> bool {
        self.closed.get()
    }

    /// What a task that answers here holds, so that nobody waits for it if it panics.
    pub fn notice_of_panic(&self) -> NoticeOfPanic<'_, A> {
        NoticeOfPanic(self)
    }
}

/// Tells the desk if it is dropped in a panic.
pub struct NoticeOfPanic<'a, A>(&'a Desk<A>);

impl<A> Drop for NoticeOfPanic<'_, A> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.panicked.set(true);
            self.0.driver.ring();
        }
    }
}

/// The task that waits for something, if one does.
#[derive(Default)]
struct Bell(Cell<Option<Waker>>);

impl Bell {
    /// Has the present task woken at the next [`ring`](Self::ring). It is nearly always the same one, so its waker is kept.
    fn wait<T>(&self, context: &Context<'_>) -> Poll<T> {
        let kept = self.0.take().filter(|waker| waker.will_wake(context.waker()));
        self.0.set(Some(kept.unwrap_or_else(|| context.waker().clone())));
        Poll::Pending
    }

    fn ring(&self) {
        if let Some(waker) = self.0.take() {
            waker.wake_by_ref();
            self.0.set(Some(waker));
        }
    }
}

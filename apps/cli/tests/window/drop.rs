//! A file dropped on the window, as a file manager does it: the XDND protocol, version 5.

use std::path::Path;
use std::time::{Duration, Instant};

use x11rb::COPY_DEPTH_FROM_PARENT;
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    ConnectionExt, CreateWindowAux, EventMask, PropMode, SELECTION_NOTIFY_EVENT, SelectionNotifyEvent,
    SelectionRequestEvent, Window, WindowClass,
};
use x11rb::wrapper::ConnectionExt as _;

use crate::display::Person;

impl Person {
    /// Drops a file in the middle of the window.
    pub fn drop_file(&mut self, path: &Path) {
        let source = self.source();
        let (list, copy) = (self.atom("text/uri-list"), self.atom("XdndActionCopy"));
        let selection = self.atom("XdndSelection");
        self.connection.set_selection_owner(source, selection, x11rb::CURRENT_TIME).unwrap();
        let uri = format!("file://{}\r\n", path.display());
        self.tell("XdndEnter", [source, 5 << 24, list, 0, 0]);
        let place = 700 << 16 | 400;
        self.tell("XdndPosition", [source, 0, place, x11rb::CURRENT_TIME, copy]);
        self.answer(&uri, "XdndStatus");
        self.tell("XdndDrop", [source, 0, x11rb::CURRENT_TIME, 0, 0]);
        self.answer(&uri, "XdndFinished");
        self.connection.destroy_window(source).unwrap();
        self.connection.flush().unwrap();
    }

    /// A window that nobody sees, to drag from.
    fn source(&self) -> Window {
        let source = self.connection.generate_id().unwrap();
        self.connection
            .create_window(
                COPY_DEPTH_FROM_PARENT,
                source,
                self.root,
                0,
                0,
                1,
                1,
                0,
                WindowClass::INPUT_OUTPUT,
                0,
                &CreateWindowAux::new(),
            )
            .unwrap();
        source
    }

    /// Hands the name of the file over when it is asked for, until the window says a word.
    fn answer(&mut self, uri: &str, last: &str) {
        let (last, begin) = (self.atom(last), Instant::now());
        while begin.elapsed() < Duration::from_secs(30) {
            match self.connection.poll_for_event().unwrap() {
                Some(Event::SelectionRequest(request)) => self.hand_over(&request, uri),
                Some(Event::ClientMessage(message)) if message.type_ == last => return,
                Some(_) => {}
                None => std::thread::sleep(Duration::from_millis(5)),
            }
        }
        panic!("the window does not take the file");
    }

    fn hand_over(&self, request: &SelectionRequestEvent, uri: &str) {
        let SelectionRequestEvent { time, requestor, selection, target, property, .. } = *request;
        let bytes = uri.as_bytes();
        self.connection.change_property8(PropMode::REPLACE, requestor, property, target, bytes).unwrap();
        let event = SelectionNotifyEvent {
            response_type: SELECTION_NOTIFY_EVENT,
            sequence: 0,
            time,
            requestor,
            selection,
            target,
            property,
        };
        self.connection.send_event(false, requestor, EventMask::NO_EVENT, event).unwrap();
        self.connection.flush().unwrap();
    }
}

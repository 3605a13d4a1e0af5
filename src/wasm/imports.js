// The functions that the module calls in the worker's script: members of the object `host` (memory.js, lab_worker.js).
mergeInto(LibraryManager.library, {
  host_reply: function (id, status, headers, bytes, size) {
    Module['host'].reply(id, status, JSON.parse(UTF8ToString(headers)), HEAPU8.slice(bytes, bytes + size));
  },
  host_event: function (name, value) {
    Module['host'].event(UTF8ToString(name), UTF8ToString(value));
  },
  host_send: function (worker, kind, bytes, size) {
    Module['host'].send(worker, kind, HEAPU8.slice(bytes, bytes + size));
  },
});

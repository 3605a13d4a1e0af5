// The cases that a laboratory in the browser cannot run, each with what it needs of the program or the machine.

const REASONS = {
  folder: 'asks before it replaces a file of a folder on the machine',
  file: 'is about files that the program writes, without the laboratory',
  rescue: 'is about files that rescue unsaved scenes',
  server: 'is about the server: its connections, clients, tabs and end',
  slow: 'is about a slow link to the server',
  thread: 'is about a measurement that is stopped, which one thread cannot',
  studies: 'is about studies, which time the program on the machine',
};

/** FILE: reason for all its cases, or {CASE: reason}. */
const TABLE = {
  document: {
    'a scene saved under another name can be opened': REASONS.folder,
    'an existing file is not overwritten without confirmation': REASONS.folder,
    'saving outside of the folder is refused': REASONS.folder,
    'Control+S saves, including a value that is being typed': REASONS.folder,
    'a file written by hand is replaced after one confirmation': REASONS.folder,
  },
  endurance: REASONS.server,
  frames: {
    'ten tabs share one stream': REASONS.server,
    'a state that comes after later events': REASONS.server,
    'the server stops and restarts': REASONS.server,
  },
  html_file: REASONS.file,
  lessons: {
    'keys move a control step by step over a slow link; nothing moves it back': REASONS.slow,
  },
  live_page: REASONS.file,
  motion: {
    'a measurement is stopped, and a scene without a slime is refused': REASONS.thread,
  },
  panels: {
    'a study, light': REASONS.studies,
    'a study, dark': REASONS.studies,
  },
  rescue: REASONS.rescue,
  studies: REASONS.studies,
};

/** Why a case is skipped; null: it is run. */
export function needsProgram(file, what) {
  const entry = TABLE[file];
  return (typeof entry === 'string' ? entry : entry?.[what]) ?? null;
}

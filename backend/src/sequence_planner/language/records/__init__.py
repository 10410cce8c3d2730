"""Records, the messages of devices and what pipelines make of them: types of fields, paths to them, and expressions."""

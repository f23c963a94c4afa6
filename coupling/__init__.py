"""Structure, contact, hand-over, exchange, ledger and scheduler: what joins sheet and rubble."""

"""What people see: terminal, report, replay, pictures. Presents content that other rooms make."""

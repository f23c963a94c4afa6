"""Pictures of the ice in two dimensions: plan and vertical sections, for pages, videos and still pictures."""
